#include "client/gcode/model/arc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace traverse::gcode {
namespace {

constexpr double kToleranceMm = 0.02;

// What the line `text` draws, from (0, 0) on; its ends included.
std::vector<Point> Drawn(const std::string& text, double& length) {
  Interpreter interpreter(text);
  Step step;
  EXPECT_TRUE(interpreter.Next(step));
  EXPECT_TRUE(step.arc);
  const Position to = interpreter.state().at;
  length = ArcLength(step.command, step.from, to, 1);
  std::vector<Point> points = ArcPoints(step.command, step.from, to, 1, kToleranceMm);
  points.insert(points.begin(), Point{});
  points.push_back({ToDouble(to.x), ToDouble(to.y)});
  return points;
}

struct Sample {
  const char* text;
  Point center;
  double radius;
  double turns;  // counterclockwise
};

class ArcPointsOf : public ::testing::TestWithParam<Sample> {};

TEST_P(ArcPointsOf, StayOnTheCircleAndTurnItsTravel) {
  const auto& [text, center, radius, turns] = GetParam();
  double length = 0;
  const std::vector<Point> points = Drawn(text, length);

  EXPECT_NEAR(length, 2 * std::numbers::pi * radius * std::abs(turns), 1e-4);
  ASSERT_GT(points.size(), 3u);
  double turned = 0;
  for (size_t i = 1; i < points.size(); ++i) {
    const Point a = {points[i - 1].x - center.x, points[i - 1].y - center.y};
    const Point b = {points[i].x - center.x, points[i].y - center.y};
    EXPECT_NEAR(std::hypot(b.x, b.y), radius, 1e-4);
    EXPECT_GE(std::hypot(a.x + b.x, a.y + b.y) / 2, radius - kToleranceMm - 1e-4);
    turned += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
  }
  EXPECT_NEAR(turned, 2 * std::numbers::pi * turns, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Circles, ArcPointsOf,
                         ::testing::Values(Sample{"G3 X10 Y0 I5 J0 E1", {5, 0}, 5, 0.5},
                                           Sample{"G2 X10 Y0 I5 J0 E1", {5, 0}, 5, -0.5},
                                           Sample{"G3 X5 Y5 I0 J5 E1", {0, 5}, 5, 0.25},
                                           Sample{"G2 X5 Y5 I0 J5 E1", {0, 5}, 5, -0.75},
                                           Sample{"G3 X0 Y0 I5 J0 E1", {5, 0}, 5, 1},
                                           Sample{"G2 X0 Y0 I5 J0 E1", {5, 0}, 5, -1},
                                           Sample{"G2 X0 Y0 I-5 E1", {-5, 0}, 5, -1},
                                           Sample{"G3 X0 Y0 I-5 J0 E1", {-5, 0}, 5, 1},
                                           Sample{"G2 X0 Y0 J5 E1", {0, 5}, 5, -1},
                                           Sample{"G3 X5 Y5 R5 E1", {0, 5}, 5, 0.25},
                                           Sample{"G3 X5 Y5 R-5 E1", {5, 0}, 5, 0.75}));

TEST(ArcPoints, NoneForAFlatArcAndNotTooManyForAHugeOne) {
  double length = 0;

  EXPECT_EQ(Drawn("G3 X1 Y0 I0.5 J100 E1", length).size(), 2u);
  EXPECT_LE(Drawn("G3 X0 Y0 I1000000 J0 E1", length).size(), 17u);
}

}  // namespace
}  // namespace traverse::gcode
