// Nearest insertion: of all paths that are left, the one with a point nearest to the route is
// inserted where it costs least, at the entry that costs least.
//
// Source: SPEC 3.3, [T] 2.6.2, [S]; Rosenkrantz, Stearns and Lewis (1977). On any plan: each
// any_order node has a route of its own between the visits before and after it; a child with paths
// of its own is inserted like a contour that has the points where it may be begun (some of these,
// if they are many), and is built inside once its place is known. Paths that wait for others are
// inserted after these, behind them. O(n^2) for n children, with bounding boxes that spare most
// vertices: 0.2 s for 5000 contours of 40.

#ifndef TRAVERSE_ENGINE_SOUZA_NEAREST_INSERTION_H_
#define TRAVERSE_ENGINE_SOUZA_NEAREST_INSERTION_H_

#include <optional>

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// A valid route; none if the budget runs out, as a part of one would be worth nothing.
std::optional<Route> NearestInsertionRoute(const LayerView& layer, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_NEAREST_INSERTION_H_
