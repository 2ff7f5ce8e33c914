// What is printed where: client/gcode/model/loops.h and outline.h.

#include "client/gcode/model/loops.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/visible_walls.h"
#include "tests/client/gcode/support/read_text.h"

namespace traverse::gcode {
namespace {

using testing::Read;

std::vector<Outline> OutlinesOf(const GcodeFile& file) {
  return gcode::OutlinesOf(file, file.layers.front());
}

const char kCircle[] = R"(;TYPE:External perimeter
G1 X20 Y10 F9000
G1 F1200
G3 X0 Y10 I-10 J0 E1
G3 X20 Y10 I10 J0 E1
G1 X30 Y10 F9000
)";

TEST(Outline, ACircleOfTwoArcsIsALoopThatBeginsWhereItDoes) {
  const auto file = Read(std::string("M83\nG1 Z.2 F9000\n") + kCircle);

  const Outline circle = OutlinesOf(*file).front();

  EXPECT_EQ(circle.points.size(), 3u);
  EXPECT_TRUE(circle.closed);
  EXPECT_TRUE(circle.one_start);
  for (const Point& point : circle.shape()) {
    EXPECT_NEAR(Distance(point, {10, 10}), 10, 1e-6);
  }
  EXPECT_GT(circle.shape().size(), 40u);
}

// Nobody can tell that one of 0.2 mm between its arcs' ends is closed.
TEST(Outline, ATinyLoopOfArcsBeginsWhereItDoes) {
  const auto file = Read(
      "M83\nG1 Z.2 F9000\n;TYPE:External perimeter\nG1 X.2 Y0\nG3 X.1 Y-.1732 I-.2 J0 E1\n"
      "G1 X.17 Y-.1 E.1\nG1 X.2 Y0 E.1\nG1 X30 Y10 F9000\n");

  const Outline loop = OutlinesOf(*file).front();

  EXPECT_TRUE(loop.closed);
  EXPECT_TRUE(loop.one_start);
}

TEST(Outline, ACircleWithoutANameIsAVisibleWall) {
  const auto file =
      Read("M83\nG1 Z.2 F9000\nG1 X20 Y10\nG3 X0 Y10 I-10 J0 E1\nG3 X20 Y10 I10 J0 E1\n");

  EXPECT_EQ(OutlinesOf(*file).front().feature, Feature::kLoop);
}

// The chord between the ends of its arcs leads through the middle; the wall does not.
TEST(VisibleWalls, OfArcsLieWhereTheyArePrinted) {
  const auto file = Read(std::string("M83\nG1 Z.2 F9000\n") + kCircle);
  const VisibleWalls walls(OutlinesOf(*file));

  EXPECT_TRUE(walls.Crossed({10, 15}, {10, 25}));
  EXPECT_TRUE(walls.Crossed({10, 5}, {10, -5}));
  EXPECT_FALSE(walls.Crossed({10, 5}, {10, 15}));
}

TEST(Outline, ArcsInInchesBendInMillimetres) {
  const auto file = Read("G20\nM83\nG1 Z.01 F400\nG1 X1 Y.5\nG3 X0 Y.5 I-.5 J0 E.04\nG1 X2 Y.5\n");

  const Outline arc = OutlinesOf(*file).front();
  for (const Point& point : arc.shape()) {
    EXPECT_NEAR(Distance(point, {12.7, 12.7}), 12.7, 1e-6);
  }
}

std::string To(double x, double y, bool prints) {
  return "G1 X" + std::to_string(x) + " Y" + std::to_string(y) + (prints ? " E.5\n" : " F9000\n");
}

// A square around (20, 20), counter-clockwise, that ends 0.06 mm short of its start.
std::string Square(double half, bool begun_elsewhere) {
  const double a = 20 - half;
  const double b = 20 + half;
  const std::string whole =
      To(b, a, true) + To(b, b, true) + To(a, b, true) + To(a, a + 0.06, true);
  if (!begun_elsewhere) return To(a, a, false) + "G1 F1200\n" + whole;
  return To(b, b, false) + "G1 F1200\n" + To(a, b, true) + To(a, a + 0.06, true) + To(a, a, false) +
         "G1 F1200\n" + To(b, a, true) + To(b, b, true);
}

// Of three walls, one within the other, the outer one is seen, wherever the others begin. (What was
// written with inner loops begun elsewhere was taken to have more visible walls: 121 travel moves
// across such became 152 in sl_vase_rack_restart_extra, and all of it was left as it was.)
TEST(Loops, ALoopBegunElsewhereIsALoop) {
  for (const bool elsewhere : {false, true}) {
    const auto file = Read("M83\nG1 Z.2 F9000\n" + Square(9.2, false) + Square(9.6, elsewhere) +
                           Square(10, false) + To(50, 50, false));
    const std::vector<Outline> outlines = OutlinesOf(*file);

    ASSERT_EQ(outlines.size(), elsewhere ? 4u : 3u);
    for (size_t path = 0; path + 1 < outlines.size(); ++path) {
      EXPECT_EQ(outlines[path].feature, Feature::kInnerWall) << path;
    }
    EXPECT_EQ(outlines.back().feature, Feature::kLoop);
  }
}

// A square within another one, of which many short segments are away from that.
TEST(Loops, WhatLiesBesideAnotherLoopForMostOfItsLengthIsAnInnerWall) {
  std::string inner = To(10.4, 10.4, false) + "G1 F1200\n";
  Point at{10.4, 10.4};
  const auto print = [&](double x, double y) {
    const double e = 0.0374 * Distance(std::exchange(at, {x, y}), {x, y});
    absl::StrAppend(&inner, "G1 X", x, " Y", y, " E", e, "\n");
  };
  print(29.6, 10.4);
  for (int i = 0; i <= 12; ++i) print(29.6 - 4.6 * i / 12, 25 + 4.6 * i / 12);
  print(10.4, 29.6);
  print(10.4, 10.4);
  const auto file = Read("M83\nG1 Z.2 F9000\n" + inner + Square(10, false) + To(50, 50, false));

  EXPECT_EQ(OutlinesOf(*file).front().feature, Feature::kInnerWall);
}

// The verifier looks straight to the outside, too: what runs past there beside the line of sight
// hides nothing.
TEST(Loops, ALoopThatOthersOnlyPassByIsSeen) {
  std::string passing;
  for (const auto& [x, y] : {std::pair(20.3, 9.7), {30.3, 20.3}, {19.7, 30.3}, {9.7, 19.7}}) {
    passing += To(x - .2, y - .2, false) + "G1 F1200\n" + To(x + .2, y - .2, true) +
               To(x + .2, y + .2, true) + To(x - .2, y + .2, true) + To(x - .2, y - .2, true);
  }
  const auto file = Read("M83\nG1 Z.2 F9000\n" + Square(10, false) + passing + To(50, 50, false));

  EXPECT_EQ(OutlinesOf(*file).front().feature, Feature::kLoop);
}

TEST(Loops, TwoLinesThatDoNotCloseAreNoLoop) {
  const auto file = Read(
      "M83\nG1 Z.2 F9000\nG1 X0 Y0\nG1 X10 Y0 E.5\nG1 X10 Y10 E.5\nG1 X10 Y10.06 F9000\n"
      "G1 X0 Y10 E.5\nG1 X0 Y5 E.5\nG1 X50 F9000\n");

  for (const Outline& outline : OutlinesOf(*file)) EXPECT_EQ(outline.feature, Feature::kLine);
}

// A square of 20 mm that ends `gap` short of its start.
std::string ClippedSquare(double gap) {
  return To(0, 0, false) + "G1 F1200\n" + To(20, 0, true) + To(20, 20, true) + To(0, 20, true) +
         To(0, gap, true) + To(50, 50, false);
}

TEST(Outline, LoopsAreClippedByTheWidthOfTheirLineOrNozzle) {
  const auto closed = [](const std::string& head, double gap, const std::string& tail) {
    const auto file =
        Read("M83\nG1 Z.2 F9000\n;TYPE:Perimeter\n" + head + ClippedSquare(gap) + tail);
    return OutlinesOf(*file).front().closed;
  };
  EXPECT_TRUE(closed(";WIDTH:0.45\n", .12, ""));
  EXPECT_FALSE(closed(";WIDTH:0.45\n", .15, ""));
  for (const double width : {0.8, 1.0, 1.8}) {
    const std::string stated = std::to_string(width);
    EXPECT_TRUE(closed(";WIDTH:" + stated + "\n", .15 * width, ""));
    EXPECT_TRUE(closed(";WIDTH:0.45\n", .15 * width, "; nozzle_diameter = " + stated + "\n"));
    EXPECT_FALSE(closed(";WIDTH:" + stated + "\n", .2 * width, ""));
  }
}

}  // namespace
}  // namespace traverse::gcode
