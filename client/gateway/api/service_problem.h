// Statuses of the optimiser service as problems.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_SERVICE_PROBLEM_H_
#define TRAVERSE_CLIENT_GATEWAY_API_SERVICE_PROBLEM_H_

#include "absl/status/status.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

// The same code and sentence as over gRPC, the fields at fault as `details`, and the service's
// advice when to come again as Retry-After. Where its limits do not allow a job at any time, 413.
HttpResponse ServiceProblem(const absl::Status& status);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_SERVICE_PROBLEM_H_
