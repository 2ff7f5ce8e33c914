#include "engine/weller/tabu/swap_candidates.h"

#include <algorithm>
#include <cstddef>

#include "engine/base/rest.h"
#include "engine/geometry/bounding_box.h"
#include "engine/model/point.h"

namespace traverse {
namespace {

// [node of the tree] center of the box around its paths, in the tree's present order.
std::vector<Point> Centers(const Plan& plan, const SequenceTree& tree, Budget& budget) {
  Rest rest(&budget);
  const std::vector<int> paths = tree.Paths();
  std::vector<Point> centers;
  for (int node = 0; node < tree.node_count(); ++node) {
    BoundingBox box;
    for (int k = tree.begin(node); k < tree.end(node); ++k) {
      const size_t path = static_cast<size_t>(paths[static_cast<size_t>(k)]);
      rest(2 + plan.paths[path].points.size());
      for (const Point& point : plan.paths[path].points) box.Add(point);
    }
    centers.push_back(box.center());
  }
  return centers;
}

}  // namespace

SwapCandidates::SwapCandidates(const Plan& plan, const SequenceTree& tree, Budget& budget)
    : near_(static_cast<size_t>(tree.node_count())) {
  const auto is_large = [&](int node) { return tree.child_count(node) > kAllSwaps; };
  const std::vector<int>& movable = tree.movable_nodes();
  if (std::none_of(movable.begin(), movable.end(), is_large)) return;
  const std::vector<Point> centers = Centers(plan, tree, budget);
  std::vector<std::pair<double, int>> by_distance;
  for (const int node : movable) {
    if (!is_large(node)) continue;
    for (int i = 0; i < tree.child_count(node) && !budget.Exhausted(); ++i) {
      const int child = tree.child_at(node, i);
      by_distance.clear();
      for (int j = 0; j < tree.child_count(node); ++j) {
        const int other = tree.child_at(node, j);
        if (j == i) continue;
        by_distance.emplace_back(
            Distance(centers[static_cast<size_t>(child)], centers[static_cast<size_t>(other)]),
            other);
      }
      std::partial_sort(by_distance.begin(), by_distance.begin() + kNear, by_distance.end());
      for (int k = 0; k < kNear; ++k) {
        near_[static_cast<size_t>(child)].push_back(by_distance[static_cast<size_t>(k)].second);
      }
    }
  }
}

}  // namespace traverse
