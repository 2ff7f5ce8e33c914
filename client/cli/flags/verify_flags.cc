#include "client/cli/flags/verify_flags.h"

#include "client/cli/flags/job_flags.h"

namespace traverse::cli {

std::vector<Flag> VerifyFlagTable() {
  return {{"policy",
           "POLICY",
           "safe, balanced, free, fast (default: as stated)",
           {"safe", "balanced", "free", "fast"}},
          AllowFlag(),
          MaxHiddenTravelFlag()};
}

absl::StatusOr<std::optional<GivenPermissions>> ParseGivenPermissions(const Flags& flags) {
  if (!flags.Has("policy") && !flags.Has("allow") && !flags.Has("max_hidden_travel")) {
    return std::nullopt;
  }
  absl::StatusOr<VerifyPermissions> permissions =
      ParsePermissions(flags.Text("policy", "safe"), flags.Text("allow"));
  if (!permissions.ok()) return permissions.status();
  const auto hidden = flags.Number("max_hidden_travel", 0, VerifyPermissions::kMostHiddenTravelMm);
  if (!hidden.ok()) return hidden.status();
  permissions->max_hidden_travel_mm = hidden->value_or(permissions->max_hidden_travel_mm);
  return GivenPermissions{*permissions, /*policy_as_stated=*/!flags.Has("policy")};
}

}  // namespace traverse::cli
