// Visible walls, which ways cross them, and travel moves around:
// client/gcode/model/visible_walls.h, detour.h.

#include "client/gcode/plan/detour.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/base/rng.h"

namespace traverse::gcode {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;

Outline Wall(const std::vector<Point>& points, Feature feature = Feature::kOuterWall) {
  Outline wall;
  wall.points = points;
  wall.closed = true;
  wall.feature = feature;
  return wall;
}

Outline Square(double x, double y, double side, Feature feature = Feature::kOuterWall) {
  return Wall({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}, {x, y}}, feature);
}

double LengthOf(Point a, const std::vector<Point>& bends, Point b) {
  double length = 0;
  for (const Point bend : bends) {
    length += Distance(a, bend);
    a = bend;
  }
  return length + Distance(a, b);
}

bool CrossesNone(const VisibleWalls& walls, Point a, const std::vector<Point>& bends, Point b) {
  for (const Point bend : bends) {
    if (walls.Crossed(a, bend)) return false;
    a = bend;
  }
  return !walls.Crossed(a, b);
}

TEST(VisibleWalls, AreOuterWallsAndNotTouchedByTravelsThatEndOnThem) {
  const VisibleWalls walls({Square(0, 0, 10), Square(1, 1, 8, Feature::kInnerWall)});

  EXPECT_TRUE(walls.Crossed({5, 5}, {15, 5}));
  EXPECT_FALSE(walls.Crossed({5, 5}, {9.5, 5}));
  EXPECT_FALSE(walls.Crossed({5, 5}, {10, 5}));
  EXPECT_FALSE(walls.Crossed({15, 5}, {10.1, 5}));
}

// A wall with two bays above a floor; the travel leaves the floor and goes past the tip between.
TEST(VisibleWalls, AreTouchedByTravelThatComesBackToItsOwn) {
  const auto touches = [](double tip, std::vector<Point> travel) {
    Outline bays = Wall({{0, 0}, {20, 0}, {20, 9}, {11, 9}, {10, tip}, {9, 9}, {0, 9}, {0, 0}});
    bays.width_mm = 0.4;
    return VisibleWalls({bays}).Touched(travel);
  };

  EXPECT_TRUE(touches(2.15, {{4, 0}, {16, 4}})) << "from the wall, past its tip";
  EXPECT_TRUE(touches(2.15, {{16, 4}, {4, 0}})) << "and to it";
  EXPECT_TRUE(touches(2.15, {{4, 0}, {16, 4}, {16, 5}}));
  EXPECT_TRUE(touches(2.15, {{4, 0.9}, {16, 3.1}})) << "that of no end";
  EXPECT_FALSE(touches(3, {{4, 0}, {16, 4}}));
  EXPECT_FALSE(touches(2.15, {{10, 2.15}, {16, 4}})) << "leaves the tip";
  EXPECT_FALSE(touches(2.15, {{0, 0}, {12, .15}, {16, 3}})) << "along the floor, and away";
}

// Behind a short first leg: what lies less than 0.25 mm from the end of the travel does not count.
TEST(VisibleWalls, AreTouchedByTravelAroundACornerOfTheirOwn) {
  Outline bend = Wall({{0, 0}, {20, 0}, {20, 20}, {10, 20}, {10, 10}, {0, 10}, {0, 0}});
  bend.width_mm = 0.62;
  const VisibleWalls walls({bend});

  EXPECT_TRUE(walls.Touched(std::vector<Point>{{10, 10.2}, {10.4, 10.16}, {2, 5}}));
  EXPECT_FALSE(walls.Touched(std::vector<Point>{{10, 10.2}, {10.35, 10}, {4, 5}}))
      << "never left it";
}

// As detours are bent, about 0.4 mm off its middle.
TEST(VisibleWalls, AreTouchedByTravelThatLeavesWideOnesAndPassesTheirTips) {
  Outline tip = Wall({{0, 0}, {5, 0}, {10, 1}, {15, 0}, {20, 0}, {20, -9}, {0, -9}, {0, 0}});
  tip.width_mm = 0.605;
  const VisibleWalls walls({tip});

  EXPECT_TRUE(walls.Touched(std::vector<Point>{{2, 0}, {5, 0.39}, {16, 1.82}}));
  EXPECT_FALSE(walls.Touched(std::vector<Point>{{2, 0}, {5, 0.39}, {16, 2.8}}));
}

// The shortest travel moves pass corners by less than coordinates tell.
TEST(Detours, CrossNoWallAsTheyAreWritten) {
  const VisibleWalls walls(
      {Square(0, 0, 40), Wall({{20, 13}, {26, 21}, {19, 27}, {14, 19}, {20, 13}})});
  const Detours detours(walls);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point a{12.3456 + .0012345 * i, 10};
    const Point b{28.7654, 27.1234 + .0009876 * i};
    const std::vector<Point> bends = detours.Around(a, b);
    found += bends.empty() ? 0 : 1;
    for (const Point bend : bends) {
      EXPECT_NEAR(bend.x * 1000, std::round(bend.x * 1000), 1e-6) << i;
      EXPECT_NEAR(bend.y * 1000, std::round(bend.y * 1000), 1e-6) << i;
    }
    EXPECT_TRUE(bends.empty() || CrossesNone(walls, a, bends, b)) << i;
  }
  EXPECT_GT(found, 1000);
}

TEST(Detours, StraightTravelsStayStraight) {
  const VisibleWalls walls({Square(0, 0, 40), Square(15, 15, 10)});

  EXPECT_THAT(Detours(walls).Around({5, 5}, {35, 5}), IsEmpty());
}

TEST(Detours, LeadAroundAHoleTheShorterTravel) {
  const VisibleWalls walls({Square(0, 0, 40), Square(15, 15, 10)});
  const Point a{5, 22};
  const Point b{35, 22};

  const std::vector<Point> bends = Detours(walls).Around(a, b);

  ASSERT_THAT(bends, Not(IsEmpty()));
  EXPECT_TRUE(CrossesNone(walls, a, bends, b));
  EXPECT_LT(LengthOf(a, bends, b), 2 * std::hypot(10, 3.5) + 11);
}

TEST(Detours, ThereIsNoneFromOneIslandToAnother) {
  const VisibleWalls walls({Square(0, 0, 10), Square(20, 0, 10)});

  EXPECT_THAT(Detours(walls).Around({5, 5}, {25, 5}), IsEmpty());
}

TEST(Detours, LeadFromAWallAlongItsInside) {
  // A horseshoe; the travel from its one leg's tip, which lies on the wall, into the other leg.
  const VisibleWalls walls(
      {Wall({{0, 0}, {40, 0}, {40, 30}, {30, 30}, {30, 10}, {10, 10}, {10, 30}, {0, 30}, {0, 0}})});
  const Point on_wall{10, 25};
  const Point inside{35, 25};

  const std::vector<Point> bends = Detours(walls).Around(on_wall, inside);

  ASSERT_THAT(bends, Not(IsEmpty()));
  EXPECT_TRUE(CrossesNone(walls, on_wall, bends, inside));
}

// Whatever is found crosses nothing, and little that is there to be found is missed.
TEST(Detours, CrossNothingAmongRandomRoundHoles) {
  int wanted = 0;
  int found = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    std::vector<Outline> outlines = {Square(0, 0, 100)};
    for (int i = 0; i < 25; ++i) {
      const Point center{10.0 + 20 * (i % 5), 10.0 + 20 * (i / 5)};
      const double radius = 2 + 6.5 * rng.Unit();
      std::vector<Point> points;
      for (int k = 0; k <= 24; ++k) {
        const double angle = 2 * std::numbers::pi * (k % 24) / 24;
        points.push_back(
            {center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
      }
      outlines.push_back(Wall(points));
    }
    const VisibleWalls walls(outlines);
    // Where the holes leave streets free.
    const Point a{20.0 * rng.Below(6), 3 + 94 * rng.Unit()};
    const Point b{3 + 94 * rng.Unit(), 20.0 * rng.Below(6)};
    const Point from{std::clamp(a.x, 1.0, 99.0), a.y};
    const Point to{b.x, std::clamp(b.y, 1.0, 99.0)};
    if (!walls.Crossed(from, to)) continue;
    ++wanted;
    const std::vector<Point> bends = Detours(walls).Around(from, to);
    if (bends.empty()) continue;
    ++found;
    EXPECT_TRUE(CrossesNone(walls, from, bends, to)) << "seed " << seed;
    EXPECT_LT(LengthOf(from, bends, to), 2 * Distance(from, to) + 10) << "seed " << seed;
  }
  EXPECT_GT(wanted, 100);
  EXPECT_GT(found, wanted * 9 / 10);
}

}  // namespace
}  // namespace traverse::gcode
