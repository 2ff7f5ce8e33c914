// The flags that say what may differ between two files that are compared.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_VERIFY_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_VERIFY_FLAGS_H_

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/flags/flags.h"
#include "client/gcode/verify/permissions.h"

namespace traverse::cli {

// The rows of --policy and --allow.
std::vector<Flag> VerifyFlagTable();

// What the two say; nothing if neither is given. InvalidArgument for words that there are not.
absl::StatusOr<std::optional<GivenPermissions>> ParseGivenPermissions(const Flags& flags);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_VERIFY_FLAGS_H_
