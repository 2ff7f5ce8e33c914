// Path relinking: the sequences between two good ones.
//
//   from    a b c d e       each step swaps the child into place that costs least there,
//           c b a d e       until the sequence is that of the guide
//           c b e d a
//   guide   c b e a d
//
// Source: thesis 2.2.8 (p. 29-30), figure 2.7, and 4.2 (p. 84): the preliminary sequence guides the
// search in step 3; Gendreau and Potvin (2010).

#ifndef TRAVERSE_ENGINE_WELLER_TABU_PATH_RELINKING_H_
#define TRAVERSE_ENGINE_WELLER_TABU_PATH_RELINKING_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/weller/tabu/link_costs.h"

namespace traverse {

// The `keep` best sequences (by cost with penalties) between `from` and `guide`, without these two,
// best first; of equal ones the earlier. Fewer if there are not so many, or the budget ends.
// O(steps x children) evaluations of swaps. REQUIRES: both are orders of the problem's plan, an
// any_order of paths without `before` pairs.
std::vector<Route> RelinkPaths(const LayerProblem& problem, const LinkRules& rules,
                               const Route& from, const Route& guide, int keep, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_PATH_RELINKING_H_
