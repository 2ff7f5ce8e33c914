// Greedy construction: repeatedly goes to the nearest point at which a path may be entered.
//
// Source: SPEC 3.2. On any plan, the tree says which paths may come next. Once a path of a node was
// visited, the node is completed first. An in_order node offers the points of its first remaining
// child; an any_order node those of each child that waits for no other one. Nearest is by length
// for every cost, because a cost never falls as the length grows. Ties go to the lowest path, then
// the first entry. About O(points log points) per level of nested any_order nodes. 5000 contours of
// 40 vertices: 90 ms.

#ifndef TRAVERSE_ENGINE_SEARCH_GREEDY_GREEDY_H_
#define TRAVERSE_ENGINE_SEARCH_GREEDY_GREEDY_H_

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// A valid route. When the budget runs out, the remaining paths follow in some order that the plan
// allows, each at its nearest entry.
Route GreedyRoute(const LayerView& layer, Budget& budget);

// The route that every strategy must at least equal: the cheaper of the greedy one and the given
// order; the latter if they cost the same, or if that would be known only long after the budget ran
// out (RouteCostInTime).
Route BaselineRoute(const LayerView& layer, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_GREEDY_GREEDY_H_
