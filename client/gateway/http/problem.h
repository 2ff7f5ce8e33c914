// Refusals as problem details (RFC 9457).

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_

#include <string>

#include "absl/status/status.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

// A response of application/problem+json. `detail` is one sentence that says what is wrong.
HttpResponse Problem(int status, const std::string& detail);

// The same for one of our statuses: INVALID_ARGUMENT is 400, FAILED_PRECONDITION (the file cannot
// be rewritten) 422, and so on. If something is full now, it is 503 with Retry-After.
HttpResponse ProblemOf(const absl::Status& status);

// Only the body.
std::string ProblemJson(int status, const std::string& detail);

// The HTTP status for one of our statuses.
int HttpStatusOf(absl::StatusCode code);

// "Bad Request".
std::string ReasonOf(int status);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_
