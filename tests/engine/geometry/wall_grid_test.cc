#include "engine/geometry/wall_grid.h"

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

TEST(WallGrid, FindsNothingWhereThereIsNothing) {
  EXPECT_FALSE(WallGrid({}, 0).Crosses({0, 0}, {1, 1}));
  const std::vector<Wall> dots = {{{{1, 1}, {1, 1}, {1, 1}}, true, -1}};
  EXPECT_FALSE(WallGrid(dots, 0).Crosses({0, 0}, {2, 2}));
  EXPECT_TRUE(WallGrid(dots, 0).segments().empty());
}

TEST(WallGrid, ClosesLoopsAndNoOthers) {
  const std::vector<Point> u = {{0, 0}, {0, 10}, {10, 10}, {10, 0}};
  const std::vector<Wall> open = {{u, false, -1}};
  const std::vector<Wall> closed = {{u, true, -1}};

  EXPECT_FALSE(WallGrid(open, 0).Crosses({5, 5}, {5, -5}));
  EXPECT_TRUE(WallGrid(closed, 0).Crosses({5, 5}, {5, -5}));
}

TEST(WallGrid, LooksAtThreeFifthsOfAShortWay) {
  const std::vector<Wall> wall = {{{{0.21, -1}, {0.21, 1}}, false, -1}};

  EXPECT_TRUE(WallGrid(wall, 100).Crosses({0, 0}, {1, 0}));
  EXPECT_FALSE(WallGrid(wall, 100).Crosses({0, 0}, {1.2, 0}));
}

double DistanceToLine(Point p, Point a, Point b) {
  const Point way{b.x - a.x, b.y - a.y};
  const double square = way.x * way.x + way.y * way.y;
  const double dot = (p.x - a.x) * way.x + (p.y - a.y) * way.y;
  const double t = square > 0 ? std::clamp(dot / square, 0.0, 1.0) : 0;
  return Distance(p, {a.x + t * way.x, a.y + t * way.y});
}

// Walls and ways of every size and place, upright and level ones among them.
TEST(WallGrid, FindsWhatLookingAtEverySegmentFinds) {
  for (uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const double size = std::pow(10, rng.Unit() * 6);
    const double far = rng.Between(0, 3) == 0 ? 1e6 - size : 0;
    const bool thin = rng.Between(0, 3) == 0;
    const auto point = [&] {
      const double x = rng.Unit() * size;
      return Point{far + x, far + (thin ? x * 1e-3 + rng.Unit() * 1e-3 : rng.Unit() * size)};
    };
    LayerWalls walls;
    for (int w = rng.Between(1, 20); w > 0; --w) {
      Wall& wall = walls.walls.emplace_back();
      wall.closed = rng.Between(0, 1) == 1;
      const Point a = point();
      wall.points = {a};
      for (int i = rng.Between(1, 30); i > 0; --i) {
        const Point before = wall.points.back();
        switch (rng.Between(0, 3)) {
          case 0:
            wall.points.push_back(point());
            break;
          case 1:
            wall.points.push_back({before.x, point().y});
            break;
          case 2:
            wall.points.push_back({point().x, before.y});
            break;
          default:
            wall.points.push_back({before.x + (rng.Unit() - 0.5) * size * 1e-3,
                                   before.y + (rng.Unit() - 0.5) * size * 1e-3});
        }
      }
    }
    const WallGrid grid(walls.walls, 0);
    for (int i = 0; i < 200; ++i) {
      const Point a = point();
      const Point b = rng.Between(0, 4) == 0 ? Point{a.x, point().y} : point();

      EXPECT_EQ(grid.Crosses(a, b), CrossesAny(walls, 0, a, b))
          << a.x << " " << a.y << " to " << b.x << " " << b.y;
      EXPECT_EQ(grid.Crosses(a, b), grid.Crosses(b, a));

      const double beside = rng.Unit() * rng.Unit() * size;
      std::vector<bool> visited(grid.segments().size());
      const auto visit = [&visited](uint32_t s) { return visited[s] = true; };
      grid.ForEachOnLine(a, b, visit, beside);
      for (size_t s = 0; s < visited.size(); ++s) {
        const Point end = grid.segments()[s].a;
        EXPECT_TRUE(visited[s] || DistanceToLine(end, a, b) > beside);
      }
    }
  }
}

}  // namespace
}  // namespace traverse
