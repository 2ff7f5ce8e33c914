#include "client/warm_start/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace traverse {
namespace {

TEST(PointTree, FindsWhatLookingAtEveryPointFinds) {
  std::mt19937 random(7);
  // Whole numbers, so that many points coincide.
  std::uniform_int_distribution<int> at(0, 12);
  for (int round = 0; round < 200; ++round) {
    std::vector<OwnedPoint> points;
    const int count = round % 40;
    for (int i = 0; i < count; ++i) {
      points.push_back({double(at(random)), double(at(random)), i / 3, i % 3});
    }
    PointTree tree(points);
    for (int query = 0; query < 30; ++query) {
      const double x = at(random) + 0.5 * (query % 2);
      const double y = at(random);
      const auto distance = [&](const OwnedPoint& p) { return std::hypot(p.x - x, p.y - y); };
      const auto nearest =
          std::min_element(points.begin(), points.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
      const OwnedPoint* found = tree.Nearest(x, y);
      ASSERT_EQ(found == nullptr, points.empty());
      if (found != nullptr) {
        EXPECT_EQ(distance(*found), distance(*nearest));
      }
      EXPECT_EQ(tree.Within(x, y, 3).size(),
                static_cast<size_t>(std::count_if(points.begin(), points.end(), [&](const auto& p) {
                  return distance(p) <= 3;
                })));
      if (query % 5 != 4 || points.empty()) continue;
      const int gone = points[static_cast<size_t>(query) % points.size()].owner;
      tree.Remove(gone);
      tree.Remove(gone);
      std::erase_if(points, [&](const OwnedPoint& p) { return p.owner == gone; });
    }
  }
}

}  // namespace
}  // namespace traverse
