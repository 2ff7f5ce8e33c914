// The order of the children of every node of a plan, under construction, and where in the route the
// paths of each node are.
//
//   any_order(a, in_order(b, c), d)        route   b c a d
//                                          ranges  in_order [0, 2), a [2, 3), d [3, 4)

#ifndef TRAVERSE_ENGINE_WELLER_TABU_SEQUENCE_TREE_H_
#define TRAVERSE_ENGINE_WELLER_TABU_SEQUENCE_TREE_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/base/rest.h"
#include "engine/base/rng.h"
#include "engine/model/plan.h"
#include "engine/model/tree/compiled_plan.h"

namespace traverse {

// Nodes have numbers of their own: those of the plan that hold paths, in preorder. Children of a
// node are known by their positions in its present order, or by their numbers, which stay.
class SequenceTree {
 public:
  // Begins with the order given (which may violate `before`). What takes long here and below lets
  // others on through `budget`, which may be null and else outlives this.
  explicit SequenceTree(const Plan& plan, Budget* budget = nullptr);

  int node_count() const { return static_cast<int>(nodes_.size()); }

  // any_order nodes with at least two children that hold paths, but for those whose pairs, passed
  // on through children without paths, are too many (PassedPairs): their order is that loaded last.
  const std::vector<int>& movable_nodes() const { return movable_; }
  int child_count(int node) const { return static_cast<int>(At(node).order.size()); }
  int child_at(int node, int position) const {
    return At(node).order[static_cast<size_t>(position)];
  }
  int position_of(int child) const { return At(child).position; }
  bool has_before(int node) const { return At(node).has_before; }
  int path_of(int node) const { return At(node).path; }  // -1: not a leaf

  // How many `before` pairs of its parent a node is in.
  int pair_count(int node) const {
    return static_cast<int>(At(node).later.size() + At(node).earlier.size());
  }

  // The paths of `node` are those at [begin, end) of the route.
  int begin(int node) const { return At(node).begin; }
  int end(int node) const { return At(node).begin + At(node).size; }

  // How many `before` pairs the present order violates.
  int violations() const { return violations_; }

  // By how much that would change if the children at positions i < j of `node` were swapped.
  // O(pairs that these two are in).
  int ViolationDelta(int node, int i, int j) const;

  // Swaps them. O(j - i and the nodes below the children concerned); O(1) for two paths.
  void Swap(int node, int i, int j);

  // Takes over the order of `paths`: every path once, those of each node together.
  void Load(const std::vector<int>& paths);

  // Puts the children of every any_order node into a random order that keeps all pairs.
  void Shuffle(Rng& rng);

  // The paths in the present order. O(n).
  std::vector<int> Paths() const;

 private:
  struct Node {
    int parent = -1;
    int position = 0;     // in the parent's order
    int begin = 0;        // where its paths begin in the route
    int size = 0;         // how many paths it has
    int subtree_end = 0;  // its subtree are the nodes from itself up to here
    int path = -1;        // of a leaf
    bool any_order = false;
    bool has_before = false;   // among its children
    std::vector<int> order;    // its children, in present order
    std::vector<int> later;    // siblings that a `before` pair puts after it
    std::vector<int> earlier;  // siblings that a `before` pair puts before it
  };

  const Node& At(int node) const { return nodes_[static_cast<size_t>(node)]; }
  Node& At(int node) { return nodes_[static_cast<size_t>(node)]; }

  // Adds a node that holds paths and those below it. Returns its number.
  int Add(const CompiledPlan& plan, int index, int parent);

  // False if they are too many.
  bool AddPairs(const CompiledPlan& plan, int index, int number);
  void Shift(int node, int by);
  void Reorder(int node);
  void CountViolations();

  mutable Rest rest_;
  std::vector<Node> nodes_;   // in preorder
  std::vector<int> open_;     // all any_order nodes of at least two children
  std::vector<int> movable_;  // of them, those whose children may change place
  std::vector<int> leaf_of_;  // [path] its node
  int violations_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_TABU_SEQUENCE_TREE_H_
