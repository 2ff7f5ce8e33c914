// The best route by what links cost (cost/link_cost.h), of small layers.

#ifndef TRAVERSE_ENGINE_PROOF_LINKED_OPTIMUM_H_
#define TRAVERSE_ENGINE_PROOF_LINKED_OPTIMUM_H_

#include <cstdint>
#include <optional>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"

namespace traverse {

// No route of the problem, which has links, costs less than the one returned. By dynamic
// programming over the sets of children that are done (Held and Karp 1962) in each node of free
// order, within each other as the plan's nodes are. Unset if that takes more than `most_links`
// costs of links, or the budget is exhausted. Memory: up to 40 MB.
std::optional<Route> LinkedOptimum(const LayerProblem& problem, int64_t most_links, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_LINKED_OPTIMUM_H_
