// Islands that count as one, whatever the distance at which they do.
//
// Where an island ends is a matter of opinion: two walls 1.5 mm apart warm each other, or do not.
// So rests (choose/rows/island_rests.h, verify/rules/rest.h) hold for all of them: for each
// connected region of paths, and for each region of such islands that are joined if those count as
// one that lie within some distance of each other, up to 2 mm. They form a tree, the nearest joined
// first.
//
//   islands   a   1.4 mm   b   1.8 mm   c      nodes   a, b, c; a+b at 1.4; a+b+c at 1.8

#ifndef TRAVERSE_CLIENT_GCODE_ISLAND_TREE_H_
#define TRAVERSE_CLIENT_GCODE_ISLAND_TREE_H_

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace traverse::gcode {

// Two islands, and how far they are apart.
struct IslandGap {
  uint32_t one = 0;
  uint32_t other = 0;
  double mm = 0;
};

class IslandTree {
 public:
  static constexpr double kMostMm = 2;

  // Distances are told apart by this much.
  static constexpr double kStepMm = 0.1;

  // `count` islands, numbered from 0, each for itself.
  explicit IslandTree(uint32_t count = 0) : nodes_(count), count_(count) {}

  // Joined where `gaps` are kMostMm at the most. O(n log n) in the gaps.
  IslandTree(uint32_t count, const std::vector<IslandGap>& gaps);

  // Nodes follow those that they join; the first `count` are the islands.
  uint32_t count() const { return count_; }
  uint32_t size() const { return static_cast<uint32_t>(nodes_.size()); }

  // The node that `node` is directly part of; `node` itself if it is of none.
  uint32_t ParentOf(uint32_t node) const {
    return nodes_[node].parent == kNone ? node : nodes_[node].parent;
  }

  // The whole that `node` is part of.
  uint32_t RootOf(uint32_t node) const;

  // Calls visit(node, other) for all pairs of a node of `tree` that `island` is part of, and one of
  // `other_tree` that `other` is part of, at the same distance.
  template <typename Visit>
  static void ForEachPair(const IslandTree& tree, uint32_t island, const IslandTree& other_tree,
                          uint32_t other, Visit visit) {
    for (;;) {
      visit(island, other);
      const int next = tree.NextStep(island);
      const int other_next = other_tree.NextStep(other);
      const int step = std::min(next, other_next);
      if (step == kNever) return;
      if (next == step) island = tree.AtStep(island, step);
      if (other_next == step) other = other_tree.AtStep(other, step);
    }
  }

 private:
  void LeaveOneOfEachStep();

  static constexpr uint32_t kNone = UINT32_MAX;
  static constexpr int kNever = std::numeric_limits<int>::max();

  struct Node {
    uint32_t parent = kNone;
    int step = 0;  // at which it came to be
  };

  // The step at which `node` becomes part of another one.
  int NextStep(uint32_t node) const {
    const uint32_t parent = nodes_[node].parent;
    return parent == kNone ? kNever : nodes_[parent].step;
  }

  // All that `node` is part of at `step`.
  uint32_t AtStep(uint32_t node, int step) const {
    while (NextStep(node) <= step) node = nodes_[node].parent;
    return node;
  }

  std::vector<Node> nodes_;
  uint32_t count_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_ISLAND_TREE_H_
