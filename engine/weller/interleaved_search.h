// The framework in interleaved deposition: island by island, as thesis 6.2 asks.

#ifndef TRAVERSE_ENGINE_WELLER_INTERLEAVED_SEARCH_H_
#define TRAVERSE_ENGINE_WELLER_INTERLEAVED_SEARCH_H_

#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/weller/framework_search.h"

namespace traverse {

// An island-by-island layer: InterleavedPlan of islands, in any order, each with at most one outer
// contour.
struct InterleavedLayer {
  std::vector<int> islands;  // nodes of the plan, in the given order
};

// Unset unless `plan` is any_order, without `before` pairs, over islands: each in_order of the
// outer contour, any_order(contours) and any_order(open paths), of which some may be missing.
// O(paths).
std::optional<InterleavedLayer> AsInterleavedLayer(const Plan& plan);

// The framework in interleaved deposition, as thesis 6.2 asks. Step 2 arranges the islands, each
// represented by its outer contour (or the ends of its rasters), with neighborhoods and clusters as
// for contours. Then steps 1 to 4 run on one island after another, each from where the one before
// ended. There the outer contour is suppressed and comes back on the first move, because only that
// one reaches the island. Always a valid route; deterministic like SearchFramework.
FrameworkResult SearchInterleaved(const LayerProblem& problem, const InterleavedLayer& layer,
                                  const FrameworkOptions& options, SequenceMethod& method,
                                  Budget& budget);
FrameworkResult SearchInterleaved(const LayerProblem& problem, const InterleavedLayer& layer,
                                  const FrameworkOptions& options, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_INTERLEAVED_SEARCH_H_
