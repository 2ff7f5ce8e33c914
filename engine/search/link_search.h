// Improves a route by what its links cost, which is not the same in both directions
// (cost/link_cost.h). The searches of the strategies know a cost that is, so better routes lie
// close to theirs.

#ifndef TRAVERSE_ENGINE_SEARCH_LINK_SEARCH_H_
#define TRAVERSE_ENGINE_SEARCH_LINK_SEARCH_H_

#include <cstdint>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"

namespace traverse {

enum class LinkEffort : uint8_t {
  kSettle,  // until no change is an improvement
  kKick,    // then kicks (Martin, Otto and Felten 1991), as long as they gain
};

// `route`, changed until no change of this kind makes it cheaper, or until the budget is exhausted:
// a path is entered elsewhere; a run of paths is done backwards; a short run comes elsewhere, as it
// is or backwards (2-opt and Or-opt between near paths). What a run costs backwards is known from
// sums along the route, so each trial takes O(1) links; a change moves numbers about, O(paths).
// REQUIRES: `route` is valid for the problem, which has links and walls_unit 1.
Route ImproveLinks(const LayerProblem& problem, const Route& route, LinkEffort effort,
                   Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_LINK_SEARCH_H_
