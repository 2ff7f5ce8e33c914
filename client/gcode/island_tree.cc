#include "client/gcode/island_tree.h"

#include <compare>
#include <numeric>
#include <utility>

namespace traverse::gcode {

IslandTree::IslandTree(uint32_t count, const std::vector<IslandGap>& gaps) : IslandTree(count) {
  struct Join {
    int step = 0;
    uint32_t one = 0;
    uint32_t other = 0;

    auto operator<=>(const Join&) const = default;
  };
  std::vector<Join> joins;
  for (const IslandGap& gap : gaps) {
    if (gap.mm > kMostMm) continue;
    joins.push_back({1 + static_cast<int>(std::max(gap.mm, 0.0) / kStepMm), gap.one, gap.other});
  }
  std::sort(joins.begin(), joins.end());
  std::vector<uint32_t> above(count);  // [node] one that it is part of; itself if it is of none
  std::iota(above.begin(), above.end(), 0);
  const auto top_of = [&above](uint32_t node) {
    while (above[node] != node) node = above[node] = above[above[node]];
    return node;
  };
  for (const Join& join : joins) {
    uint32_t one = top_of(join.one);
    uint32_t other = top_of(join.other);
    if (one == other) continue;
    if (one > other) std::swap(one, other);
    if (nodes_[other].step != join.step) {
      nodes_.push_back({kNone, join.step});
      above.push_back(size() - 1);
      nodes_[other].parent = above[other] = size() - 1;
      other = size() - 1;
    }
    nodes_[one].parent = above[one] = other;
  }
  LeaveOneOfEachStep();
}

// Of wholes that were joined at one step only the last stays above others, so that no node has more
// above it than there are steps.
void IslandTree::LeaveOneOfEachStep() {
  for (uint32_t node = size(); node-- > 0;) {
    uint32_t& parent = nodes_[node].parent;
    if (parent == kNone) continue;
    const uint32_t whole = nodes_[parent].parent;
    if (whole != kNone && nodes_[whole].step == nodes_[parent].step) parent = whole;
  }
}

uint32_t IslandTree::RootOf(uint32_t node) const {
  while (nodes_[node].parent != kNone) node = nodes_[node].parent;
  return node;
}

}  // namespace traverse::gcode
