// Greedy construction: repeatedly the nearest point at which a path may be begun.
//
// Source: SPEC 3.2. On any plan: which paths may be next follows from the tree. A node is completed
// once one of its paths was visited; of an in_order node, the first child left offers its points;
// of an any_order node, each child does that waits for no other one. Nearest is by length for every
// cost: a cost never falls with the length. Ties go to the lowest path, then the first entry.
// About O(points log points) a level of nested any_order nodes. 5000 contours of 40 vertices: 90
// ms.

#ifndef TRAVERSE_ENGINE_SEARCH_GREEDY_GREEDY_H_
#define TRAVERSE_ENGINE_SEARCH_GREEDY_GREEDY_H_

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// A valid route. When the budget runs out, the paths left follow in some order that the plan
// allows, each at its nearest entry.
Route GreedyRoute(const LayerView& layer, Budget& budget);

// The route that no strategy may fall behind: the cheaper of the greedy one and the order given,
// the latter if they cost the same.
Route BaselineRoute(const LayerView& layer, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_GREEDY_GREEDY_H_
