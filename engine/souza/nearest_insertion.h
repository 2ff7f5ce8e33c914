// Nearest insertion: takes the remaining path with a point nearest to the route, and inserts it
// where it costs least, at the entry that costs least.
//
// Source: SPEC 3.3, [T] 2.6.2, [S]; Rosenkrantz, Stearns and Lewis (1977). On any plan: each
// any_order node has a route of its own between the visits before and after it. A child with paths
// of its own is inserted like a contour that has the points where it may begin (a sample if they
// are many), and is built inside once its position is known. Paths that wait for others are
// inserted after these, behind them. O(n^2) for n children; bounding boxes spare most vertices: 0.2
// s for 5000 contours of 40.

#ifndef TRAVERSE_ENGINE_SOUZA_NEAREST_INSERTION_H_
#define TRAVERSE_ENGINE_SOUZA_NEAREST_INSERTION_H_

#include <optional>

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// A valid route; unset if the budget runs out, because a part of one would be worth nothing.
std::optional<Route> NearestInsertionRoute(const LayerView& layer, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_NEAREST_INSERTION_H_
