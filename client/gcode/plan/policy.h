// What may change in a sliced file: policies, allowances, crossings.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_POLICY_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_POLICY_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::gcode {

enum class Policy : uint8_t {
  kSafe,      // nothing that a slicer chose for quality changes
  kBalanced,  // also walls may begin at their sharp corners
  kFree,      // any start and direction; only what touches keeps the order of its features
  kFast,      // the same, and travel pays only for what shows
};

// Any start and any direction.
inline bool IsFree(Policy policy) { return policy >= Policy::kFree; }

// "safe", "balanced", "free" or "fast"; nothing for other text.
std::optional<Policy> PolicyOfName(std::string_view name);
std::string_view PolicyName(Policy policy);

// As long as CuraEngine's longest move within a part without a retraction.
inline constexpr double kMaxHiddenTravelMm = 30;
inline constexpr double kMostHiddenTravelMm = 1000;  // that may be asked for

// What a user allows beyond any policy; each has a name.
struct Allowance {
  bool infill_order = false;  // walls and the infill that touches them may change places
  bool wall_order = false;    // walls that touch each other may
  bool fan_order = false;     // paths may across a change of the fan
  bool wipes = false;         // a path's wipe is made only where the travel behind it retracts

  // Travel that nobody can see (hidden/hidden_moves.h) does without a retraction, a lift and a
  // wipe, if it is not longer than this. 0: none is.
  bool hidden_retractions = false;
  double max_hidden_travel_mm = kMaxHiddenTravelMm;

  // The same, and travel that would have to retract is led around walls within the part where that
  // hides it and takes less time.
  bool inner_detours = false;

  bool operator==(const Allowance&) const = default;
};

// `allow` with what the policy itself allows.
Allowance AllowedUnder(Policy policy, Allowance allow);

// Parses names separated by commas, such as "infill_order,wall_order"; nothing for other text.
std::optional<Allowance> AllowanceOfNames(std::string_view names);

// "infill_order+wall_order"; empty if nothing is allowed.
std::string AllowanceNames(const Allowance& allow);

// How travel treats visible walls.
enum class Crossings : uint8_t {
  kKeep,   // the file crosses them no more often than before
  kFewer,  // and each crossing saved is worth kFewerCrossingSeconds
  kAny,    // only time counts
};

// Prices of a crossing in a search. The small one prefers orders that are as fast with fewer
// crossings.
inline constexpr double kKeepCrossingSeconds = 0.03;
inline constexpr double kFewerCrossingSeconds = 0.5;

// "keep", "fewer" or "any"; nothing for other text.
std::optional<Crossings> CrossingsOfName(std::string_view name);

// What may change in a file. One value from the flags or the request to the choice of orders.
struct Liberties {
  Policy policy = Policy::kSafe;
  Crossings crossings = Crossings::kKeep;
  Allowance allow = {};

  // No island rests shorter than so long, or than in the file (choose/rows/island_rests.h). Except
  // under Policy::kFree none rests shorter than the file's least layer time either.
  double min_revisit_seconds = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_POLICY_H_
