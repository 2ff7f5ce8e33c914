// Which swaps a search tries.

#ifndef TRAVERSE_ENGINE_WELLER_TABU_SWAP_CANDIDATES_H_
#define TRAVERSE_ENGINE_WELLER_TABU_SWAP_CANDIDATES_H_

#include <cassert>
#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/plan.h"
#include "engine/weller/tabu/sequence_tree.h"

namespace traverse {

// Of the nodes with more than kAllSwaps children, the pairs that would make a child the successor
// or predecessor of one of the kNear children whose bounding boxes are centered nearest to it;
// nodes with fewer children try every pair (SwapTable). Immutable.
class SwapCandidates {
 public:
  static constexpr int kAllSwaps = 40;
  static constexpr int kNear = 6;

  // O(k^2) for nodes with k > kAllSwaps children; lists are incomplete if the budget ends.
  SwapCandidates(const Plan& plan, const SequenceTree& tree, Budget& budget);

  // Calls `function(j)` for the positions whose children may change places with the one at `i`, in
  // the present order; one may come twice. REQUIRES: `node` has more than kAllSwaps children.
  template <typename Function>
  void ForRow(const SequenceTree& tree, int node, int i, const Function& function) const {
    assert(tree.child_count(node) > kAllSwaps);
    for (const int near : near_[static_cast<size_t>(tree.child_at(node, i))]) {
      const int at = tree.position_of(near);
      for (const int j : {at - 1, at + 1}) {
        if (j >= 0 && j < tree.child_count(node) && j != i) function(j);
      }
    }
  }

 private:
  std::vector<std::vector<int>> near_;  // [child] its near siblings
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_SWAP_CANDIDATES_H_
