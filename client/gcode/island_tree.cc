#include "client/gcode/island_tree.h"

#include <cmath>
#include <tuple>

namespace traverse::gcode {

IslandTree::IslandTree(uint32_t count, const std::vector<IslandGap>& gaps) : IslandTree(count) {
  struct Join {
    int step = 0;
    uint32_t one = 0;
    uint32_t other = 0;
  };
  std::vector<Join> joins;
  for (const IslandGap& gap : gaps) {
    if (gap.mm > kMostMm) continue;
    joins.push_back({1 + static_cast<int>(std::max(gap.mm, 0.0) / kStepMm), gap.one, gap.other});
  }
  std::sort(joins.begin(), joins.end(), [](const Join& a, const Join& b) {
    return std::tie(a.step, a.one, a.other) < std::tie(b.step, b.one, b.other);
  });
  for (const Join& join : joins) {
    uint32_t one = RootOf(join.one);
    uint32_t other = RootOf(join.other);
    if (one == other) continue;
    if (one > other) std::swap(one, other);
    if (nodes_[other].step != join.step) {
      nodes_.push_back({kNone, join.step});
      nodes_[other].parent = size() - 1;
      other = size() - 1;
    }
    nodes_[one].parent = other;
  }
}

uint32_t IslandTree::RootOf(uint32_t node) const {
  while (nodes_[node].parent != kNone) node = nodes_[node].parent;
  return node;
}

}  // namespace traverse::gcode
