// Descent: alternates 2-opt and point release, on any plan, until neither finds a gain.
//
// 2-opt works on one any_order node after another: the node's children are blocks between the
// visits before and after it, each with its own order inside (BlockLine). Point release works on
// all visits.

#ifndef TRAVERSE_ENGINE_SOUZA_DESCENT_H_
#define TRAVERSE_ENGINE_SOUZA_DESCENT_H_

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"
#include "engine/souza/search_route.h"

namespace traverse {

struct DescentOptions {
  // If false, the entries of contours stay, and only the direction of open paths changes.
  bool point_release = true;
};

// Improves `route`. Returns the change of cost, <= 0.
double Descend(SearchRoute& route, const DescentOptions& options, Budget& budget);

// A valid route that costs no more than `route`, which is valid. Options as above. When the budget
// runs out, the route as improved so far.
Route Improve(const LayerView& layer, const Route& route, const DescentOptions& options,
              Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_DESCENT_H_
