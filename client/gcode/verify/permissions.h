// What a rewriter was allowed to change.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_PERMISSIONS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_PERMISSIONS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace traverse {

// Either text may have or lack comments that begin with this.
inline constexpr std::string_view kOptimisedMark = "; optimised by Traverse";

struct VerifyPermissions {
  static constexpr double kUsualHiddenTravelMm = 30;
  static constexpr double kMostHiddenTravelMm = 1000;

  // In order: each policy allows what those before it allow.
  enum class Policy : uint8_t { kSafe, kBalanced, kFree, kFast };

  Policy policy = Policy::kSafe;
  bool infill_order = false;  // walls and infill that touch may change places
  bool wall_order = false;    // walls that touch may
  bool fan_order = false;     // paths may change places across a change of the fan
  bool wipes = false;         // a wipe may be missing where nothing is retracted

  // Travel that nobody sees, and that is no longer than this, may lack its retraction, its lift and
  // its wipe.
  bool hidden_retractions = false;
  double max_hidden_travel_mm = kUsualHiddenTravelMm;

  // The same, and such travel may lead around outer walls within the part.
  bool inner_detours = false;

  bool is_free() const { return policy >= Policy::kFree; }
  bool drops_wipes() const { return wipes || policy == Policy::kFast; }
  bool hides_travel() const {
    return (hidden_retractions || leads_within()) && max_hidden_travel_mm > 0;
  }
  bool leads_within() const { return inner_detours || policy == Policy::kFast; }
};

// Parses the values of the command line: "safe", "balanced", "free" or "fast", and a list such as
// "infill_order,wall_order", which may be empty. InvalidArgument for other words.
absl::StatusOr<VerifyPermissions> ParsePermissions(std::string_view policy, std::string_view allow);

// Reads the writer's line at the head of `text`:
//
//   ; optimised by Traverse 1.2.0, policy balanced, allow wall_order+fan_order: travel ...
//   ; optimised by Traverse 1.2.0, policy fast, max_hidden_travel 20: travel ...
//
// Nothing if there is no such line before the first command, or it names no policy.
std::optional<VerifyPermissions> PermissionsInHead(std::string_view text);

// Permissions that a caller gives instead of those that the optimised file states.
struct GivenPermissions {
  VerifyPermissions permissions;
  bool policy_as_stated = false;  // the policy is the file's, or safe if it states none
};

// What may have changed in `optimised`: as given, else as its head states, else `safe`.
VerifyPermissions PermissionsFor(const std::optional<GivenPermissions>& given,
                                 std::string_view optimised);

// "balanced, wall_order, fan_order".
std::string DescribePermissions(const VerifyPermissions& permissions);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_PERMISSIONS_H_
