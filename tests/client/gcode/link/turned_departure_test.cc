#include "client/gcode/link/turned_departure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace traverse::gcode {
namespace {

// A square of 10 mm, anticlockwise, that ends .1 mm short of its start.
const std::vector<Point> kSquare = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, .1}};

void ExpectAt(const std::optional<Point>& found, double x, double y) {
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->x, x, 1e-9);
  EXPECT_NEAR(found->y, y, 1e-9);
}

TEST(TurnedDeparture, LeadsToTheSameSideAtEachCorner) {
  const Point within{.3, .2};
  ExpectAt(TurnedDeparture(kSquare, 1, within), 9.8, .3);
  ExpectAt(TurnedDeparture(kSquare, 2, within), 9.7, 9.8);
  ExpectAt(TurnedDeparture(kSquare, 3, within), .2, 9.7);
}

// By a third of the angle, as PrusaSlicer does: of 90 degrees within, and of 270 outside.
TEST(TurnedDeparture, DividesTheAngleAtTheNewStartAsItDid) {
  const std::vector<Point> triangle = {{0, 0}, {10, 0}, {10, 10}, {0, 0}};
  const auto at = [](double angle) {
    return Point{.4 * std::cos(angle * M_PI / 180), .4 * std::sin(angle * M_PI / 180)};
  };
  // The angles of the triangle are 45, 90 and 45 degrees.
  const Point within = at(30);
  ExpectAt(TurnedDeparture(triangle, 1, at(15)), 10 - .4 * .5, .4 * std::sqrt(.75));
  ExpectAt(TurnedDeparture(kSquare, 1, within), 10 - .4 * .5, .4 * std::sqrt(.75));
  ExpectAt(TurnedDeparture(kSquare, 1, at(-90)), 10.4, 0);
  ExpectAt(TurnedDeparture(triangle, 1, at(-105)), 10 + .4, 0);
}

TEST(TurnedDeparture, IsNoLongerThanTheFirstSegment) {
  const std::vector<Point> points = {{0, 0}, {10, 0}, {10, .25}, {10, 10}, {0, 10}, {0, 0}};
  ExpectAt(TurnedDeparture(points, 1, {.3, .4}), 10 - .2, .15);
}

TEST(TurnedDeparture, IsNoneIfTheFileLeadsNowhereOrAlongASegment) {
  EXPECT_FALSE(TurnedDeparture(kSquare, 1, {0, 0}));
  EXPECT_FALSE(TurnedDeparture(kSquare, 1, {.4, 0}));
  EXPECT_FALSE(TurnedDeparture(kSquare, 1, {0, .4}));
}

}  // namespace
}  // namespace traverse::gcode
