// The ids of jobs: who made them, for whom, and nothing that can be guessed.
//
//   gateway-7.farm-7f4c9a02e1b3...     NAME - 56 hexadecimal digits
//                  |       |       |
//                  this    128     64 bits of an HMAC of them and the caller
//                  process random
//
// So a gateway knows without remembering whether it gave an id to a caller.

#ifndef TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_IDS_H_
#define TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_IDS_H_

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace traverse::gateway {

// Whether ids may begin with `name`: 1 to 64 letters, digits, `.`, `_` and `-`.
bool IsGatewayName(std::string_view name);

// Thread-safe.
class JobIds {
 public:
  // Unavailable if the system has no random numbers. REQUIRES: IsGatewayName(name).
  static absl::StatusOr<JobIds> Make(std::string name);

  // A new id for `caller`. Unavailable as above.
  absl::StatusOr<std::string> New(const std::string& caller) const;

  // OK if this process gave `id` to `caller`. Otherwise FailedPrecondition if it is another
  // gateway's, Aborted if an earlier process of this name made it, or else NotFound.
  absl::Status Check(std::string_view id, const std::string& caller) const;

 private:
  explicit JobIds(std::string name) : name_(std::move(name)) {}

  // Of the digits before it.
  std::string Signature(std::string_view digits, const std::string& caller) const;

  std::string name_;
  std::string process_;                     // its digits
  std::array<unsigned char, 32> secret_{};  // of the signatures
};

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_JOBS_JOB_IDS_H_
