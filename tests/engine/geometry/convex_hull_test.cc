#include "engine/geometry/convex_hull.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ConvexHull, GoesCounterclockwiseFromTheLeft) {
  const std::vector<Point> points = {{2, 2}, {4, 0}, {1, 1}, {0, 0},
                                     {4, 4}, {0, 4}, {4, 2}, {0, 0}};

  EXPECT_THAT(ConvexHull(points), ElementsAre(3, 1, 4, 5));
}

TEST(ConvexHull, OfDegeneratePoints) {
  EXPECT_THAT(ConvexHull(std::vector<Point>{}), IsEmpty());
  EXPECT_THAT(ConvexHull(std::vector<Point>{{1, 1}, {1, 1}}), ElementsAre(0));
  EXPECT_THAT(ConvexHull(std::vector<Point>{{2, 2}, {1, 1}, {3, 3}, {1, 1}}), ElementsAre(1, 2));
}

TEST(ConvexHull, HasEveryPointOnItsLeft) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    std::vector<Point> points;
    for (int i = rng.Between(3, 30); i > 0; --i) {
      points.push_back({double(rng.Between(0, 9)), double(rng.Between(0, 9))});
    }

    const std::vector<int> hull = ConvexHull(points);

    for (size_t i = 0; i < hull.size(); ++i) {
      const Point tail = points[size_t(hull[i])];
      const Point head = points[size_t(hull[(i + 1) % hull.size()])];
      for (const Point& point : points) EXPECT_GE(Cross(tail, head, point), 0);
    }
  }
}

TEST(OuterTangents, TouchTheExtremesSeenFromTheFirstSet) {
  const std::vector<Point> a = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  const std::vector<Point> b = {{10, -1}, {12, -1}, {12, 3}, {10, 3}};

  const auto tangents = FindOuterTangents(a, b);

  ASSERT_TRUE(tangents.has_value());
  EXPECT_EQ(tangents->a_left, 3);
  EXPECT_EQ(tangents->b_left, 3);
  EXPECT_EQ(tangents->a_right, 0);
  EXPECT_EQ(tangents->b_right, 0);
}

TEST(OuterTangents, AreMissingWhereOneHullLiesInTheOther) {
  const std::vector<Point> ring = {{0, 0}, {9, 0}, {9, 9}, {0, 9}};
  const std::vector<Point> inner = {{4, 4}, {5, 4}, {4, 5}};
  const std::vector<Point> across = {{-1, 4}, {10, 4}, {10, 5}, {-1, 5}};

  EXPECT_FALSE(FindOuterTangents(ring, inner).has_value());
  EXPECT_FALSE(FindOuterTangents(inner, ring).has_value());
  EXPECT_FALSE(FindOuterTangents(ring, across).has_value());
}

}  // namespace
}  // namespace traverse
