#include "engine/geometry/bounding_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace traverse {
namespace {

TEST(BoundingBox, HoldsItsPoints) {
  const std::vector<Point> points = {{3, 1}, {-1, 2}, {1, 7}};

  const BoundingBox box(points);

  EXPECT_EQ(box.low(), (Point{-1, 1}));
  EXPECT_EQ(box.high(), (Point{3, 7}));
  EXPECT_EQ(box.center(), (Point{1, 4}));
  EXPECT_DOUBLE_EQ(box.shorter_side(), 4);
  EXPECT_TRUE(BoundingBox().empty());
  EXPECT_FALSE(box.empty());
}

TEST(BoundingBox, DistancesAreToTheNearestAndTheFarthestPlace) {
  const BoundingBox box(std::vector<Point>{{0, 0}, {4, 2}});

  EXPECT_DOUBLE_EQ(box.DistanceTo(Point{1, 1}), 0);
  EXPECT_DOUBLE_EQ(box.DistanceTo(Point{7, 6}), 5);
  EXPECT_DOUBLE_EQ(box.DistanceTo(BoundingBox(std::vector<Point>{{1, 5}, {9, 9}})), 3);
  EXPECT_DOUBLE_EQ(box.FarthestCornerDistance({1, 2}), std::sqrt(13.0));
}

TEST(BoundingBox, GrowsByBoxesAndNotByEmptyOnes) {
  BoundingBox box;
  box.Add(Point{1, 1});
  box.Add(BoundingBox());
  EXPECT_EQ(box.high(), (Point{1, 1}));

  BoundingBox other;
  other.Add(Point{3, 0});
  box.Add(other);
  EXPECT_EQ(box.low(), (Point{1, 0}));
  EXPECT_EQ(box.high(), (Point{3, 1}));
}

TEST(BoundingBox, SquaredDistanceIsThatToTheNearestPoint) {
  BoundingBox box;
  box.Add(Point{0, 0});
  box.Add(Point{2, 2});

  EXPECT_EQ(box.SquaredDistanceTo({1, 1}), 0);
  EXPECT_EQ(box.SquaredDistanceTo({5, 6}), 9 + 16);
  EXPECT_EQ(box.SquaredDistanceTo({1, -3}), 9);
}

}  // namespace
}  // namespace traverse
