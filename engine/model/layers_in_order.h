// Layers that are done one right after the other, as one plan.

#ifndef TRAVERSE_ENGINE_MODEL_LAYERS_IN_ORDER_H_
#define TRAVERSE_ENGINE_MODEL_LAYERS_IN_ORDER_H_

#include <vector>

#include "absl/types/span.h"
#include "engine/model/plan.h"
#include "engine/model/route.h"

namespace traverse {

// in_order(layers...). The paths of each layer are numbered on from those of the layers before it.
Plan PlanInOrder(absl::Span<const Plan* const> layers);

// A route of PlanInOrder(layers) from a route of each layer, and back.
// REQUIRES: `route` has as many visits as `layers` have paths, those of each layer together.
Route RouteInOrder(absl::Span<const Route* const> routes);
std::vector<Route> RoutesOfEach(absl::Span<const Plan* const> layers, const Route& route);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_LAYERS_IN_ORDER_H_
