// Refusals as problem details (RFC 9457).

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_

#include <string>

#include "absl/status/status.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

// A response of application/problem+json. `detail` is one sentence that says what is wrong.
HttpResponse Problem(int status, const std::string& detail);

// The same for a status of ours: INVALID_ARGUMENT is 400, FAILED_PRECONDITION (the file cannot be
// rewritten) 422, and so on. What is full now is 503 with Retry-After.
HttpResponse ProblemOf(const absl::Status& status);

// The body alone.
std::string ProblemJson(int status, const std::string& detail);

// The status of HTTP for a status of ours.
int HttpStatusOf(absl::StatusCode code);

// "Bad Request".
std::string ReasonOf(int status);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_
