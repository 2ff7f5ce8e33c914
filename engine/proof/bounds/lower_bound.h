// A lower bound of what any route of a layer costs: cheap, always valid, for every plan.

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_

#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"

namespace traverse {

// What a search for a bound found out, for the same plan with another start.
using BoundMultipliers = std::vector<double>;

// In the unit of the problem's cost, `finish` included; never above `target`, the cost of a route.
// Unset if the budget ends before there is a bound. Deterministic unless the budget ends it.
//
// `multipliers`, if not null, are used instead of searching for better ones, unless they are of
// another number of paths: then they become what was found. The same plan at a neighboring start
// has nearly as good a bound by them, at a small part of the time. Any are valid.
//
// `effort` is that of linear programmes (programme_bound.h), beyond trees.
//
// Linear memory but for these. Bounds by trees (tree_bound.h): 4 ms for 26 contours and 26 rasters,
// 0.3 s for 500 and 500.
std::optional<double> LowerBound(const LayerProblem& problem, double target,
                                 BoundMultipliers* multipliers, double effort, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_
