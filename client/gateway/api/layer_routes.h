// The service's own calls as JSON over HTTP: /v1/optimize, /v1/strategies.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_LAYER_ROUTES_H_
#define TRAVERSE_CLIENT_GATEWAY_API_LAYER_ROUTES_H_

#include <string>

#include "client/gateway/core.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

// POST /v1/optimize: OptimizeBatch. The body is an OptimizeBatchRequest in protobuf's JSON, plain
// or in gzip; the answer OptimizeBatchResponses, one a line as they come, or with Accept:
// application/json all in one document.
HttpDecision OptimizeRoute(const HttpRequest& request, const std::string& caller, Core& core);

// GET /v1/strategies: ListStrategies.
HttpDecision StrategiesRoute(const std::string& caller, Core& core);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_LAYER_ROUTES_H_
