// The length of a route's travel by the kind of move, for reports.

#ifndef TRAVERSE_ENGINE_COST_TRAVEL_SPLIT_H_
#define TRAVERSE_ENGINE_COST_TRAVEL_SPLIT_H_

#include "engine/model/plan.h"
#include "engine/model/route.h"
#include "engine/model/travel_split.h"

namespace traverse {

// The moves of `route` from `start` to its last path. REQUIRES: `route` is a route of `plan`.
TravelSplit SplitTravel(const Plan& plan, const Route& route, Point start);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_TRAVEL_SPLIT_H_
