// Refusals as problem details (RFC 9457).

#ifndef TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_
#define TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/gateway/http/message.h"

namespace traverse::gateway {

// A response of application/problem+json. `detail` is one sentence that says what is wrong.
HttpResponse Problem(int status, const std::string& detail);

// The same for one of our statuses: INVALID_ARGUMENT is 400, FAILED_PRECONDITION (the file cannot
// be rewritten) 422, and so on. If something is full now, it is 503 with Retry-After.
HttpResponse ProblemOf(const absl::Status& status);

// A field at fault, as google.rpc.BadRequest lists it.
struct ProblemField {
  std::string field;
  std::string description;
};

// What a problem may say besides its sentence.
struct ProblemDetails {
  std::string code = {};                    // the name of the gRPC status; empty: none
  std::vector<ProblemField> faults = {};    // all of them, if the sentence is the first one
  std::optional<int64_t> retry_after = {};  // seconds
};

// The members `code`, `details` and `retry_after`, as far as they are known, are an extension that
// RFC 9457 allows. If `retry_after` is set, so is the header.
HttpResponse Problem(int status, const std::string& detail, const ProblemDetails& details);

// Only the body.
std::string ProblemJson(int status, const std::string& detail);

// The HTTP status for one of our statuses.
int HttpStatusOf(absl::StatusCode code);

// "Bad Request".
std::string ReasonOf(int status);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_HTTP_PROBLEM_H_
