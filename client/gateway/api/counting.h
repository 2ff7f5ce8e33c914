// Counts HTTP requests by route and status, whoever answers them and when.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_COUNTING_H_
#define TRAVERSE_CLIENT_GATEWAY_API_COUNTING_H_

#include <string>

#include "client/gateway/gateway_metrics.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

// `decision`, whose outcome is counted once under `route`, including uploads that break off (as
// 400) and clients that leave (as 499). `metrics` must outlive it.
HttpDecision Counted(HttpDecision decision, const std::string& route, GatewayMetrics& metrics);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_COUNTING_H_
