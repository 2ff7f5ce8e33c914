// What the verifier says of two texts, in one status.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_VERIFIED_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_VERIFIED_H_

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "client/gcode/verify/verifier.h"

namespace traverse {

// Options that only check that both print the same.
inline VerifyOptions OnlySamePrint() {
  VerifyOptions options;
  options.rules = RuleBit(VerifyRule::kSamePrint);
  return options;
}

// OK if there is no break; otherwise FailedPrecondition with the first one.
inline absl::Status VerifyGcode(std::string_view original, const std::string& original_name,
                                std::string_view optimised, const std::string& optimised_name,
                                const VerifyOptions& options = {}) {
  const VerifyReport report =
      CheckGcode(original, original_name, optimised, optimised_name, options);
  if (report.ok()) return absl::OkStatus();
  return absl::FailedPreconditionError(report.breaks.front().message);
}

}  // namespace traverse

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_SUPPORT_VERIFIED_H_
