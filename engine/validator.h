// The validator: is a route legal, and how long is it? The last look before a route leaves the
// engine, so it shares no code with what it checks: it knows the model alone.

#ifndef TRAVERSE_ENGINE_VALIDATOR_H_
#define TRAVERSE_ENGINE_VALIDATOR_H_

#include "absl/status/status.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/route.h"
#include "engine/model/travel_split.h"

namespace traverse {

// OK if `route` visits every path of `plan` once, each at an entry that it allows, in an order that
// the tree allows. FailedPrecondition otherwise, with the first fault found, such as
// `route[3]: path 7 was visited before` or `nodes[2]: its paths are not done in one go`.
// REQUIRES: `plan` passes CheckPlan. O(visits + nodes + entries + pairs).
absl::Status ValidateRoute(const Plan& plan, const Route& route);

// Travel in mm of `route` from `start` to the last exit; a move from the start counts as one from a
// contour. REQUIRES: `route` is valid.
TravelSplit MeasureTravel(const Plan& plan, Point start, const Route& route);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_VALIDATOR_H_
