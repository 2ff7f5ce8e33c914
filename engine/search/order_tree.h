// The tree of a plan, compiled for local search: what may move where.

#ifndef TRAVERSE_ENGINE_SEARCH_ORDER_TREE_H_
#define TRAVERSE_ENGINE_SEARCH_ORDER_TREE_H_

#include <cassert>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/plan.h"
#include "engine/model/tree/compiled_plan.h"

namespace traverse {

// A plan's tree reduced to what matters for the order. Nodes without paths are gone (their `before`
// pairs are passed on); nodes with one child are replaced by that child. Items are numbered: 0 ..
// path_count() - 1 are the leaves, by path; then start() and finish(), two leaves for the head's
// positions before and after the layer; then the inner nodes. The root is in_order(start, plan,
// finish), so that every leaf of a path has a leaf before and after it.
class OrderTree {
 public:
  // Asks `budget` regularly, if it is not null; the tree is complete in any case.
  explicit OrderTree(const CompiledPlan& plan, Budget* budget = nullptr);
  explicit OrderTree(const Plan& plan, Budget* budget = nullptr);

  int path_count() const { return start_; }
  int leaf_count() const { return start_ + 2; }
  int item_count() const { return static_cast<int>(parent_.size()); }
  int start() const { return start_; }
  int finish() const { return start_ + 1; }
  int root() const { return start_ + 2; }

  int parent(int item) const { return parent_[Index(item)]; }  // -1 for the root
  int depth(int item) const { return depth_[Index(item)]; }
  int size(int item) const { return size_[Index(item)]; }  // leaves below, 1 for a leaf

  // Whether the children of `item` may change places. Not in an any_order node whose pairs, passed
  // on, would be too many (PassedPairs).
  bool free_order(int item) const { return free_order_[Index(item)]; }

  // Whether everything below may run backwards: paths can be reversed and no order is fixed.
  bool reversible(int item) const { return reversible_[Index(item)]; }

  // Whether that is true for all children of `item`.
  bool children_reversible(int item) const { return children_reversible_[Index(item)]; }

  // Whether `item` has children whose order is not free.
  bool has_pairs(int item) const { return has_pairs_[Index(item)]; }

  // Siblings of `item` that must come after it, or before it, by a pair of their parent.
  absl::Span<const int> after(int item) const { return Range(after_, after_first_, item); }
  absl::Span<const int> before(int item) const { return Range(before_, before_first_, item); }

  // Whether there are nodes whose leaves change position when others move.
  bool nested() const { return nested_; }

  // Whether the plan leaves any order open.
  bool has_choice() const { return has_choice_; }

  absl::Span<const int> children(int item) const { return Range(children_, children_first_, item); }

  // Whether `item` is below `node`. O(depth).
  bool IsBelow(int node, int item) const {
    while (item >= 0 && item != node) item = parent(item);
    return item == node;
  }

  // The child of `node` that contains `leaf`, or is it. REQUIRES: `leaf` is below `node`.
  int ChildHolding(int node, int leaf) const {
    int item = leaf;
    assert(IsBelow(node, leaf));
    while (parent(item) != node) item = parent(item);
    return item;
  }

  // The deepest node that contains both leaves. REQUIRES: they differ.
  int CommonNode(int leaf1, int leaf2) const {
    assert(leaf1 != leaf2);
    int a = parent(leaf1);
    int b = parent(leaf2);
    while (a != b) {
      if (depth(a) >= depth(b)) {
        a = parent(a);
      } else {
        b = parent(b);
      }
    }
    return a;
  }

 private:
  class Compiler;

  static size_t Index(int item) { return static_cast<size_t>(item); }

  static absl::Span<const int> Range(const std::vector<int>& values, const std::vector<int>& first,
                                     int item) {
    const size_t begin = Index(first[Index(item)]);
    const size_t end = Index(first[Index(item) + 1]);
    return absl::MakeConstSpan(values.data() + begin, end - begin);
  }

  int start_;
  bool nested_ = false;
  bool has_choice_ = false;
  std::vector<int> parent_;                // [item]
  std::vector<int> depth_;                 // [item], 0 for the root
  std::vector<int> size_;                  // [item]
  std::vector<char> free_order_;           // [item]
  std::vector<char> reversible_;           // [item]
  std::vector<char> children_reversible_;  // [item]
  std::vector<char> has_pairs_;            // [item]
  std::vector<int> after_, after_first_;   // [after_first_[item]] and on: siblings
  std::vector<int> before_, before_first_;
  std::vector<int> children_, children_first_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_ORDER_TREE_H_
