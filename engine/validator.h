// The validator: is a route legal, and how long is it? The last look before a route leaves the
// engine, so it shares no code with what it checks: it knows the model alone.

#ifndef TRAVERSE_ENGINE_VALIDATOR_H_
#define TRAVERSE_ENGINE_VALIDATOR_H_

#include <vector>

#include "absl/status/status.h"
#include "engine/base/budget.h"
#include "engine/model/cost_spec.h"
#include "engine/model/moves.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/route.h"
#include "engine/model/travel_split.h"
#include "engine/model/walls.h"

namespace traverse {

// OK if `route` visits every path of `plan` once, each at an entry that it allows, in an order that
// the tree allows. FailedPrecondition otherwise, with the first fault found, such as
// `route[3]: path 7 was visited before` or `nodes[2]: its paths are not done in one go`.
// REQUIRES: `plan` passes CheckPlan. O(visits + nodes + entries + pairs). `budget`, if there is
// one, is asked meanwhile, and what it answers changes nothing.
absl::Status ValidateRoute(const Plan& plan, const Route& route, Budget* budget = nullptr);

// Travel in mm of `route` from `start` to the last exit; a move from the start counts as one from a
// contour. REQUIRES: `route` is valid. `budget` as above.
TravelSplit MeasureTravel(const Plan& plan, Point start, const Route& route,
                          Budget* budget = nullptr);

// What is said of the moves of a route in a layer with walls.
struct MoveClaims {
  double cost = 0;
  MoveCounts counts;
  std::vector<Detour> detours;  // in the order of their visits
};

// OK if the moves of `route` from `start` on cost what is claimed, and are so many;
// FailedPrecondition with what they cost, or with the first detour that crosses a wall. Moves that
// touch a wall within rounding may count either way. REQUIRES: `route` is valid, `walls` passes
// CheckWalls and the cost is a time. O(n log n + m k) for n points of walls and m moves that pass k
// segments in y. `budget`, if there is one, is asked meanwhile; once it is cancelled, for nobody
// wants to know any more, the rest counts as right.
absl::Status ValidateMoves(const Plan& plan, const LayerWalls& walls, const CostSpec& spec,
                           Point start, const Route& route, const MoveClaims& claims,
                           Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_VALIDATOR_H_
