// Parameters of a request, in the query or as fields of a form: the flags of `traverse optimize`
// without their dashes.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_PARAMETERS_H_
#define TRAVERSE_CLIENT_GATEWAY_API_PARAMETERS_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/flags/flags.h"
#include "client/gateway/work/file_worker.h"
#include "client/gcode/verify/permissions.h"

namespace traverse::gateway {

using Parameters = std::vector<std::pair<std::string, std::string>>;

// All parameters: the rows of the command line's tables that name no file of this machine, and
// `name` and `report`.
std::vector<cli::Flag> ParameterTable();

// InvalidArgument, in one line, for a parameter that is unknown (with the nearest known one), given
// twice, or has a bad value. Does not set finish_by.
absl::StatusOr<FileRequest> ParseParameters(const Parameters& parameters);

// The same for the API's message.
absl::StatusOr<FileRequest> RequestOf(const v1::RewriteOptions& options);

// The parameter `deadline`, the only one of layers that come as JSON: time for the answer.
// Infinite if it is not given. Errors as above.
absl::StatusOr<absl::Duration> ParseDeadline(const Parameters& parameters);

// What may differ between two files that are compared: the parameters are the flags of
// `traverse verify` of cli::VerifyFlagTable. Nothing if neither is given. Errors as above.
absl::StatusOr<std::optional<GivenPermissions>> ParseVerifyParameters(const Parameters& parameters);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_PARAMETERS_H_
