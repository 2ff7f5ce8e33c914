#include "engine/geometry/nearest_point_index.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "tests/support/growth.h"

namespace traverse {
namespace {

TEST(NearestPointIndex, OfNothingFindsNothing) {
  const NearestPointIndex index({});

  EXPECT_EQ(index.size(), 0);
  EXPECT_EQ(index.Nearest({0, 0}), -1);
  EXPECT_EQ(index.Any(), -1);
}

TEST(NearestPointIndex, BreaksTiesByTheSmallestId) {
  NearestPointIndex index(std::vector<Point>(100, Point{3, 3}));

  EXPECT_EQ(index.Nearest({0, 0}), 0);
  index.Remove(0);
  index.Remove(1);
  EXPECT_EQ(index.Nearest({3, 3}), 2);
  index.Insert(1);
  EXPECT_EQ(index.Nearest({9, 9}), 1);
}

// The plain model: a scan of all.
int NearestByScan(const std::vector<Point>& points, const std::vector<bool>& in, Point p) {
  int nearest = -1;
  double least = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double dx = points[i].x - p.x;
    const double dy = points[i].y - p.y;
    if (in[i] && (nearest < 0 || dx * dx + dy * dy < least)) {
      least = dx * dx + dy * dy;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

TEST(NearestPointIndex, AgreesWithAScanWhilePointsLeaveAndComeBack) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const bool on_grid = seed % 3 == 0;
    const bool on_line = seed % 5 == 0;
    const auto coordinate = [&] {
      const double c = rng.Unit() * 20 - 10;
      return on_grid ? std::round(c) : c;
    };
    std::vector<Point> points(static_cast<size_t>(rng.Between(1, 200)));
    for (Point& point : points) point = {coordinate(), on_line ? 1e6 : coordinate()};
    std::vector<bool> in(points.size(), true);
    NearestPointIndex index(points);

    for (int step = 0; step < 400; ++step) {
      const Point p{coordinate() * 1.5, coordinate() * 1.5};
      EXPECT_EQ(index.Nearest(p), NearestByScan(points, in, p));
      const int any = index.Any();
      EXPECT_EQ(any < 0, index.size() == 0);
      EXPECT_TRUE(any < 0 || in[static_cast<size_t>(any)]);
      const int id = rng.Between(0, static_cast<int>(points.size()) - 1);
      const bool was_in = in[static_cast<size_t>(id)];
      in[static_cast<size_t>(id)] = !was_in;
      was_in ? index.Remove(id) : index.Insert(id);
    }
  }
}

// Each search went through all that were left.
TEST(NearestPointIndex, PointsInOnePlaceTakeNoLongerEach) {
  const auto empty = [](int points) {
    NearestPointIndex index(std::vector<Point>(static_cast<size_t>(points), Point{3, 3}));
    for (int id = 0; id < points; ++id) {
      ASSERT_EQ(index.Nearest({0, 0}), id);
      index.Remove(id);
    }
  };
  EXPECT_LT(testing::GrowthOfFour(5000, empty), testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse
