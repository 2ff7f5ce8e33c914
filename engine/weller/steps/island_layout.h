// The islands of a plan, and the plan's classical form, on which the framework's four steps work.
//
// Source: thesis 3.1 (p. 55-57): a layer is built island by island in the data, contours first and
// then rasters in the route. SPEC section 1.

#ifndef TRAVERSE_ENGINE_WELLER_STEPS_ISLAND_LAYOUT_H_
#define TRAVERSE_ENGINE_WELLER_STEPS_ISLAND_LAYOUT_H_

#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/plan.h"

namespace traverse {

// One connected region of a layer. Members are indices into Plan::paths, in their order there.
struct Island {
  std::vector<int> contours;  // all of them, including the outer one
  std::vector<int> rasters;   // all open paths
  int outer = -1;             // the contour around the island; -1 if unknown
};

struct IslandLayout {
  std::vector<Island> islands;
  std::vector<int> island_of;  // [path] index into `islands`
};

// The islands of `plan` by Path::island, in the order of their first paths. A path without an
// island (Path::island < 0, as in plans that did not come from islands) is an island of its own
// without an outer contour: then step 1 suppresses no contour, near raster points are unknown
// (NearRasterPoints falls back to spaced points), and step 4 may order the rasters freely. O(paths
// log paths). Yields to others through `budget`, which may be null.
IslandLayout IslandsOf(const Plan& plan, Budget* budget = nullptr);

// A layer in sequential deposition: all contours in any order, then all open paths in any order.
// Indices into Plan::paths, in the given order.
struct ClassicalLayer {
  std::vector<int> contours;
  std::vector<int> rasters;
};

// Unset unless `plan` is in_order(any_order(contours), any_order(open paths)) without
// `before` pairs. Either any_order may be empty or missing, and then so may the in_order.
// O(paths).
std::optional<ClassicalLayer> AsClassicalLayer(const Plan& plan);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_STEPS_ISLAND_LAYOUT_H_
