#include "engine/geometry/wall_detour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "tests/support/problems/walled_problem.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

constexpr double kSlack = 0.25;

Wall Box(double x, double y, double width, double height) {
  return {{{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, true, -1};
}

// Whether the straight piece from bend `k` of a way to bend `m` crosses a wall. Only the way's ends
// lie on lines that it need not mind.
bool PieceCrosses(const LayerWalls& walls, const std::vector<Point>& way, size_t k, size_t m) {
  Point from = way[k];
  Point to = way[m];
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double cut = std::min(kSlack / length, 0.2);
  const Point off{(to.x - from.x) * cut, (to.y - from.y) * cut};
  if (k == 0) from = {from.x + off.x, from.y + off.y};
  if (m + 1 == way.size()) to = {to.x - off.x, to.y - off.y};
  return CrossesAny(walls, 0, from, to);
}

TEST(WallDetours, LeadAroundAHole) {
  const std::vector<Wall> walls = {Box(0, 0, 40, 40), Box(15, 15, 10, 10)};
  const WallGrid grid(walls, kSlack);

  const std::vector<Point> bends = WallDetours(grid, 0.4, 0.3).Around({5, 18}, {35, 18});

  ASSERT_EQ(bends.size(), 2u);
  for (const Point& bend : bends) EXPECT_NEAR(bend.y, 14.6, 1e-9);
}

TEST(WallDetours, AreNoneFromIslandToIslandAndWhereNothingIsInTheWay) {
  const std::vector<Wall> walls = {Box(0, 0, 10, 10), Box(20, 0, 10, 10)};
  const WallGrid grid(walls, kSlack);
  const WallDetours detours(grid, 0.4, 0.3);

  EXPECT_TRUE(detours.Around({5, 5}, {25, 5}).empty());
  EXPECT_TRUE(detours.Around({2, 5}, {8, 5}).empty());
}

// To look for each wall's last crossing takes the square of their number.
TEST(WallDetours, AreNotLookedForThroughAThousandWalls) {
  std::vector<Wall> walls = {Box(-10, -10, 20'020, 40)};
  for (int i = 0; i < 2000; ++i) walls.push_back(Box(10 * i, 0, 5, 5));
  const WallGrid grid(walls, kSlack);

  int64_t tests = 0;
  EXPECT_TRUE(WallDetours(grid, 0.4, 0.3).Around({-5, 2}, {20'005, 2}, &tests).empty());
  EXPECT_LT(tests, 2000) << "the first few hundred say enough";
  EXPECT_FALSE(WallDetours(grid, 0.4, 0.3).Around({-5, 2}, {1007, 2}).empty());
}

// What the corners of the wall itself leave in sight is known without a look at the walls.
TEST(WallDetours, AskLittleAlongAWallOfManyCorners) {
  std::vector<Wall> walls = {Box(0, 0, 40, 40), {{}, true, -1}};
  for (int i = 0; i < 400; ++i) {
    walls[1].points.push_back({20 + 10 * std::cos(i * 0.015708), 20 + 10 * std::sin(i * 0.015708)});
  }
  const WallGrid grid(walls, kSlack);

  int64_t tests = 0;
  EXPECT_FALSE(WallDetours(grid, 0.4, 0.3).Around({5, 21}, {35, 21}, &tests).empty());

  EXPECT_LT(tests, 60) << "both ways along 200 corners";
}

TEST(WallDetours, CrossNothingAreTautAndTheSameThereAndBack) {
  int found = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    // A ring of holes in a star of an outline.
    LayerWalls walls;
    Wall& star = walls.walls.emplace_back();
    star.closed = true;
    for (int i = 0; i < 24; ++i) {
      const double reach = (i % 2 == 0 ? 50 : 25) + rng.Unit() * 10;
      star.points.push_back({reach * std::cos(i * 0.2618), reach * std::sin(i * 0.2618)});
    }
    for (int i = 0; i < 5; ++i) {
      walls.walls.push_back(Box(15 * std::cos(i * 1.2566) - 2, 15 * std::sin(i * 1.2566) - 2,
                                1 + rng.Unit() * 6, 1 + rng.Unit() * 6));
    }
    const WallGrid grid(walls.walls, kSlack);
    const WallDetours detours(grid, 0.4, 0.3);
    for (int i = 0; i < 50; ++i) {
      const auto point = [&] { return Point{rng.Unit() * 70 - 35, rng.Unit() * 70 - 35}; };
      const Point a = point();
      const Point b = point();

      const std::vector<Point> there = detours.Around(a, b);

      const std::vector<Point> back = detours.Around(b, a);
      EXPECT_EQ(there.empty(), back.empty());
      EXPECT_TRUE(there.empty() || CrossesAny(walls, kSlack, a, b));
      found += there.empty() ? 0 : 1;
      if (there.empty()) continue;
      std::vector<Point> way = {a};
      way.insert(way.end(), there.begin(), there.end());
      way.push_back(b);
      for (size_t k = 0; k + 1 < way.size(); ++k) {
        EXPECT_FALSE(PieceCrosses(walls, way, k, k + 1));
        EXPECT_TRUE(k + 2 == way.size() || PieceCrosses(walls, way, k, k + 2));
      }
    }
  }
  EXPECT_GT(found, 1000);
}

}  // namespace
}  // namespace traverse
