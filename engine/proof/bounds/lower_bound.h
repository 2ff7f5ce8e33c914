// A lower bound of the cost of every route of a layer: cheap, always valid, for every plan.

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_

#include <limits>
#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"

namespace traverse {

// The result of a search for a bound, reusable for the same plan with another start: [end of a
// path]. Any values are valid.
using BoundMultipliers = std::vector<double>;

// In the unit of the problem's cost, including `finish`; never above `target`, the cost of a route.
// Unset if the budget ends before there is a bound. Deterministic unless the budget ends it.
//
// If `multipliers` is not null, the search begins with them and leaves its own there: the same plan
// at a neighboring start then has nearly as good a bound in less time. Those for another number of
// paths are replaced.
//
// `effort` limits the work, about as a search's effort does: up to 1 half of what a search of 1
// takes, beyond more, and linear programmes (programme_bound.h) after the trees. `most_seconds` is
// about what the searches for multipliers may take, by counts of work.
//
// Linear memory, except for these. Bounds by trees (tree_bound.h): 4 ms for 26 contours and 26
// rasters, 0.3 s for 500 and 500.
std::optional<double> LowerBound(const LayerProblem& problem, double target,
                                 BoundMultipliers* multipliers, double effort, Budget& budget,
                                 double most_seconds = std::numeric_limits<double>::infinity());

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_
