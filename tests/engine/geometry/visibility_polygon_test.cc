#include "engine/geometry/visibility_polygon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/geometry/convex_hull.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;

// Corners and middles of the sides, counterclockwise from the lower left corner.
std::vector<Point> Square(Point corner, double side) {
  const double h = side / 2;
  std::vector<Point> points = {{0, 0},       {h, 0},    {side, 0}, {side, h},
                               {side, side}, {h, side}, {0, side}, {0, h}};
  for (Point& point : points) point = {point.x + corner.x, point.y + corner.y};
  return points;
}

// Figure 3.8 (b): from the origin only the near side of the first contour is seen.
TEST(VisibilityPolygon, FromTheOriginEndsAtTheChordOfTheTangents) {
  const std::vector<Point> origin = {{0, 0}};
  const std::vector<Point> b = Square({10, -2}, 4);

  const VisiblePoints visible = FindVisiblePoints(origin, b).value();

  EXPECT_THAT(visible.a, ElementsAre(0));
  EXPECT_THAT(visible.b, ElementsAre(0, 6, 7));
}

// Figure 3.8 (c): of the larger contour the side that faces the other one. The tangents narrow
// towards the smaller one and touch its far corners, so all of it is seen.
TEST(VisibilityPolygon, OfTwoContoursEndsAtTheChordsOfTheTangents) {
  const std::vector<Point> a = Square({0, 0}, 4);
  const std::vector<Point> d = Square({20, 1}, 2);

  const VisiblePoints visible = FindVisiblePoints(a, d).value();

  EXPECT_THAT(visible.a, ElementsAre(2, 3, 4));
  EXPECT_EQ(visible.b.size(), 8u);
}

// Octagons of the same size: the tangents touch both at the top and at the bottom.
TEST(VisibilityPolygon, OfEqualContoursHoldsTheFacingSides) {
  const std::vector<Point> a = {{3, 0},  {2, 2},   {0, 3},  {-2, 2},
                                {-3, 0}, {-2, -2}, {0, -3}, {2, -2}};
  std::vector<Point> b = a;
  for (Point& point : b) point.x += 20;

  const VisiblePoints visible = FindVisiblePoints(a, b).value();

  EXPECT_THAT(visible.a, ElementsAre(0, 1, 2, 6, 7));
  EXPECT_THAT(visible.b, ElementsAre(2, 3, 4, 5, 6));
}

// A finger that reaches into a fork: the nearest points lie beyond the chords.
TEST(VisibilityPolygon, IsMissingBetweenInterlockedContours) {
  const std::vector<Point> fork = {{0, 0}, {9, 0}, {9, 1}, {1, 1}, {1, 8}, {9, 8}, {9, 9}, {0, 9}};
  const std::vector<Point> finger = {{3, 4}, {20, 3}, {20, 6}, {3, 5}};

  EXPECT_FALSE(FindVisiblePoints(fork, finger).has_value());
}

TEST(VisibilityPolygon, IsMissingBetweenNestedContours) {
  const std::vector<Point> outer = Square({0, 0}, 20);
  const std::vector<Point> inner = Square({8, 8}, 4);

  EXPECT_FALSE(FindVisiblePoints(outer, inner).has_value());
  EXPECT_FALSE(FindVisiblePoints(inner, outer).has_value());
}

TEST(VisibilityPolygon, OfDegenerateContours) {
  const std::vector<Point> point = {{1, 1}};
  const std::vector<Point> line = {{3, 3}, {5, 5}, {4, 4}, {3, 3}};

  EXPECT_FALSE(FindVisiblePoints(point, point).has_value());
  EXPECT_THAT(FindVisiblePoints(point, line)->a, ElementsAre(0));
  EXPECT_THAT(FindVisiblePoints(point, line)->b, ElementsAre(0, 1, 2, 3));
}

std::vector<Point> RandomRing(Rng& rng) {
  const Point center{rng.Unit() * 100, rng.Unit() * 100};
  const int n = rng.Between(1, 20);
  std::vector<Point> ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * i / n;
    const double radius = 5 + 5 * rng.Unit();
    ring.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
  }
  return ring;
}

TEST(VisibilityPolygon, PointsLieBetweenTheTangentsAndTheChords) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const std::vector<Point> a = RandomRing(rng);
    const std::vector<Point> b = RandomRing(rng);

    const auto visible = FindVisiblePoints(a, b);

    if (!visible) {
      EXPECT_LT(Distance(a[0], b[0]), 40);  // else the rings are apart
      continue;
    }
    ASSERT_FALSE(visible->a.empty());
    ASSERT_FALSE(visible->b.empty());
    const auto tangents = FindOuterTangents(a, b);
    const Point polygon[] = {a[size_t(tangents->a_left)], a[size_t(tangents->a_right)],
                             b[size_t(tangents->b_right)], b[size_t(tangents->b_left)]};
    const auto inside = [&](Point point) {
      for (int i = 0; i < 4; ++i) {
        if (Cross(polygon[i], polygon[(i + 1) % 4], point) < -1e-6) return false;
      }
      return true;
    };
    for (const int i : visible->a) EXPECT_TRUE(inside(a[size_t(i)])) << "a " << i;
    for (const int i : visible->b) EXPECT_TRUE(inside(b[size_t(i)])) << "b " << i;
    // What is left out lies outside the polygon.
    for (int i = 0; i < static_cast<int>(a.size()); ++i) {
      const bool kept = std::count(visible->a.begin(), visible->a.end(), i) > 0;
      EXPECT_EQ(kept, inside(a[size_t(i)])) << "a " << i;
    }
  }
}

}  // namespace
}  // namespace traverse
