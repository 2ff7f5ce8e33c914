// The pairs `before` of a node, reduced to its children that have paths.

#ifndef TRAVERSE_ENGINE_MODEL_TREE_PASSED_PAIRS_H_
#define TRAVERSE_ENGINE_MODEL_TREE_PASSED_PAIRS_H_

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/plan.h"

namespace traverse {

// Returns all pairs (i, j) of positions in node.children, both marked by `has_paths`, such that i
// comes before j by a pair, or by several pairs through children without paths: a before empty and
// empty before b make a before b. No pair comes twice.
//
// An empty child after k children and before k others gives k^2 such pairs. So that a plan never
// takes more time and memory than its size warrants, the result is nullopt if finding them takes
// more than kPassedPairsEach steps for each child and pair of the node, and more than kPassedPairs.
// The order of the node's children is then best left as given. Asks `budget` regularly, if it is
// not null.
std::optional<std::vector<std::pair<int, int>>> PassedPairs(const PlanNode& node,
                                                            const std::vector<bool>& has_paths,
                                                            Budget* budget = nullptr);

inline constexpr size_t kPassedPairsEach = 8;
inline constexpr size_t kPassedPairs = 1 << 16;

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_TREE_PASSED_PAIRS_H_
