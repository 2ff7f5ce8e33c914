// A lower bound of the cost of every route of a layer: cheap, always valid, for every plan.

#ifndef TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_
#define TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_

#include <memory>
#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"

namespace traverse {

class VertexBound;

// What a search for a bound found, for the next one on the same plan with another start. Any
// multipliers are valid.
struct BoundSearch {
  BoundSearch();
  ~BoundSearch();
  BoundSearch(BoundSearch&&) noexcept;
  BoundSearch& operator=(BoundSearch&&) noexcept;

  // Lets the search go, all but the multipliers, and gives others their turn meanwhile.
  void Clear(Budget& budget);

  std::vector<double> multipliers;      // [end of a path]: little, of use for an equal plan too
  std::unique_ptr<VertexBound> points;  // for the very plan
};

// In the unit of the problem's cost, including `finish`; never above `target`, the cost of a route.
// Unset if the budget ends before there is a bound. Deterministic unless the budget ends it.
//
// If `search` is not null, this goes on from it, or begins with its multipliers, and leaves in it
// what was found: the same plan at a neighboring start then has nearly as good a bound in a small
// part of the time. Multipliers for another number of paths are replaced. REQUIRES: search->points
// is null, or of this very plan, which outlives it.
//
// `effort` is the effort of linear programmes (programme_bound.h), which follow the trees.
//
// Linear memory, except for these. Bounds by trees (tree_bound.h): 4 ms for 26 contours and 26
// rasters, 0.3 s for 500 and 500.
std::optional<double> LowerBound(const LayerProblem& problem, double target, BoundSearch* search,
                                 double effort, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_BOUNDS_LOWER_BOUND_H_
