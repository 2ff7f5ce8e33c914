// Two layers, one done right after the other, as one plan.

#ifndef TRAVERSE_ENGINE_MODEL_TWO_LAYERS_H_
#define TRAVERSE_ENGINE_MODEL_TWO_LAYERS_H_

#include "engine/model/plan.h"
#include "engine/model/route.h"

namespace traverse {

// in_order(first, second). The paths of `second` are numbered from first.paths.size() on.
Plan PlanOfBoth(const Plan& first, const Plan& second);

// A route of PlanOfBoth from a route of each, and back; `paths`: how many the first layer has.
Route RouteOfBoth(const Route& first, const Route& second, int paths);
Route RouteOfFirst(const Route& both, int paths);
Route RouteOfSecond(const Route& both, int paths);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_TWO_LAYERS_H_
