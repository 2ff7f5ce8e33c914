// A plan's tree, computed once: parents, sizes, and the children that have paths. The
// algorithms' own trees build on it (plan_tree.h, search/order_tree.h,
// weller/tabu/sequence_tree.h).

#ifndef TRAVERSE_ENGINE_MODEL_TREE_COMPILED_PLAN_H_
#define TRAVERSE_ENGINE_MODEL_TREE_COMPILED_PLAN_H_

#include <optional>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/plan.h"

namespace traverse {

// Nodes keep the numbers that they have in the plan. A slot is the position of a child among those
// children of its node that have paths; children without paths have no place in a route. O(nodes)
// to build. Immutable.
class CompiledPlan {
 public:
  // `plan` must outlive this object. Asks `budget` regularly, if it is not null.
  explicit CompiledPlan(const Plan& plan, Budget* budget = nullptr);

  const Plan& plan() const { return *plan_; }
  const PlanNode& node(int index) const { return plan_->nodes[static_cast<size_t>(index)]; }
  int node_count() const { return static_cast<int>(plan_->nodes.size()); }
  bool is_leaf(int index) const { return node(index).kind == PlanNode::Kind::kPath; }

  // The parent of a node; -1 for the root.
  int parent(int index) const { return parent_[static_cast<size_t>(index)]; }

  // The leaf node of a path.
  int leaf(int path) const { return leaf_[static_cast<size_t>(path)]; }

  // The number of paths in the subtree of a node.
  int path_count(int index) const { return path_count_[static_cast<size_t>(index)]; }

  // The children that have paths, in the given order: element [s] is the child of slot s.
  absl::Span<const int> children(int index) const {
    const size_t begin = static_cast<size_t>(first_child_[static_cast<size_t>(index)]);
    const size_t end = static_cast<size_t>(first_child_[static_cast<size_t>(index) + 1]);
    return absl::MakeConstSpan(children_).subspan(begin, end - begin);
  }

  // Where children(index) begins in a list of the children of all nodes, for arrays with the same
  // layout; first_child(node_count()) is the length of that list.
  int first_child(int index) const { return first_child_[static_cast<size_t>(index)]; }

  // The pairs `before` of a node as pairs of slots, including those through children without paths;
  // nullopt if there are too many (passed_pairs.h). `budget` as above.
  std::optional<std::vector<std::pair<int, int>>> SlotPairs(int index,
                                                            Budget* budget = nullptr) const;

 private:
  void CountPaths(Budget* budget);
  void ListChildren(Budget* budget);

  const Plan* plan_;
  std::vector<int> parent_;       // [node]
  std::vector<int> leaf_;         // [path]
  std::vector<int> path_count_;   // [node]
  std::vector<int> first_child_;  // [node] where its children begin in children_; one more
  std::vector<int> children_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_TREE_COMPILED_PLAN_H_
