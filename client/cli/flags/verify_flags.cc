#include "client/cli/flags/verify_flags.h"

namespace traverse::cli {

std::vector<Flag> VerifyFlagTable() {
  return {{"policy",
           "POLICY",
           "safe, balanced, free, fast (default: as the file says)",
           {"safe", "balanced", "free", "fast"}},
          {"allow", "NAME,...", "infill_order, wall_order, fan_order, wipes"}};
}

absl::StatusOr<std::optional<GivenPermissions>> ParseGivenPermissions(const Flags& flags) {
  if (!flags.Has("policy") && !flags.Has("allow")) return std::nullopt;
  const absl::StatusOr<VerifyPermissions> permissions =
      ParsePermissions(flags.Text("policy", "safe"), flags.Text("allow"));
  if (!permissions.ok()) return permissions.status();
  return GivenPermissions{*permissions, /*policy_as_stated=*/!flags.Has("policy")};
}

}  // namespace traverse::cli
