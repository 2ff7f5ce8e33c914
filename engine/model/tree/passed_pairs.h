// The pairs `before` of a node among those of its children that have paths.

#ifndef TRAVERSE_ENGINE_MODEL_TREE_PASSED_PAIRS_H_
#define TRAVERSE_ENGINE_MODEL_TREE_PASSED_PAIRS_H_

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/plan.h"

namespace traverse {

// All pairs (i, j) of positions in node.children, both marked by `has_paths`, such that i comes
// before j by a pair, or by pairs through children without paths: a before empty before b is a
// before b. No pair twice.
//
// k children before an empty one before k others are k^2 such pairs. So that a plan takes no more
// time and memory than it is large, there are none, that is nullopt, where finding them takes more
// than kPassedPairsEach steps for each child and pair of the node, and more than kPassedPairs: then
// the order of the node's children is best left as it is. `budget`, if there is one, is asked
// meanwhile.
std::optional<std::vector<std::pair<int, int>>> PassedPairs(const PlanNode& node,
                                                            const std::vector<bool>& has_paths,
                                                            Budget* budget = nullptr);

inline constexpr size_t kPassedPairsEach = 8;
inline constexpr size_t kPassedPairs = 1 << 16;

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_TREE_PASSED_PAIRS_H_
