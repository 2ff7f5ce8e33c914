// The validator: checks that a route is legal, and measures it. It is the last check before a route
// leaves the engine, so it shares no code with what it checks and uses only the model.

#ifndef TRAVERSE_ENGINE_VALIDATOR_H_
#define TRAVERSE_ENGINE_VALIDATOR_H_

#include <vector>

#include "absl/status/status.h"
#include "engine/base/budget.h"
#include "engine/model/cost_spec.h"
#include "engine/model/links.h"
#include "engine/model/moves.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/route.h"
#include "engine/model/travel_split.h"
#include "engine/model/walls.h"

namespace traverse {

// Returns OK if `route` visits every path of `plan` once, each at an entry that the plan allows, in
// an order that the tree allows. Otherwise returns FailedPrecondition with the first fault found,
// such as `route[3]: path 7 was visited before` or `nodes[2]: other paths come between its own`.
// Asks `budget` regularly, if it is not null, but always finishes. O(visits + nodes + entries +
// pairs). REQUIRES: `plan` passes CheckPlan.
absl::Status ValidateRoute(const Plan& plan, const Route& route, Budget* budget = nullptr);

// Returns the travel of `route` in mm, from `start` to the last exit. A move from the start counts
// as one from a contour. Asks `budget` as above. `links` may be null. REQUIRES: `route` is valid.
TravelSplit MeasureTravel(const Plan& plan, Point start, const Route& route,
                          Budget* budget = nullptr, const LayerLinks* links = nullptr);

// What a strategy claims about the moves of a route in a layer with walls.
struct MoveClaims {
  double cost = 0;
  MoveCounts counts;
  std::vector<Detour> detours;  // in the order of their visits
};

// Returns OK if the moves of `route` from `start` on cost what is claimed and number as many as
// claimed. Otherwise returns FailedPrecondition with what they cost, or with the first detour that
// crosses a wall. Moves that touch a wall within rounding may count either way. Asks `budget`
// regularly, if it is not null; once that is cancelled, nobody needs the result, and the rest
// counts as right. O(n log n + m k) for n points of walls and m moves that pass k segments in y.
// With `links` (null: none) moves begin where these say, and departures and arrivals count;
// `before`: what it took to leave for `start`.
// REQUIRES: `route` is valid, `walls` passes CheckWalls, LinksFit, and the cost is a time.
absl::Status ValidateMoves(const Plan& plan, const LayerWalls& walls, const CostSpec& spec,
                           Point start, const Route& route, const MoveClaims& claims,
                           Budget* budget = nullptr, const LayerLinks* links = nullptr,
                           const LinkSeconds& before = {});

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_VALIDATOR_H_
