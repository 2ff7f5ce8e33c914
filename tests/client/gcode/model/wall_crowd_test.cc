// Walls of which there are more than can be printed: client/gcode/model/wall_crowd.h.

#include "client/gcode/model/wall_crowd.h"

#include <gtest/gtest.h>

#include <string>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/model/visible_walls.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using testing::Read;

// Lines of 10 mm side by side, as many as fit into a square, and each printed four times.
TEST(WallCrowd, TakesWhatIsPrintedMoreThanOnce) {
  WallCrowd crowd({0, 0}, {10, 10});

  for (int times = 0; times < 4; ++times) {
    for (int line = 0; line < 25; ++line) {
      EXPECT_TRUE(crowd.Takes({{0.4 * line, 0}, {0.4 * line, 10}}));
    }
  }
}

TEST(WallCrowd, TakesNoMoreThanAPlaceHasRoomFor) {
  WallCrowd crowd({0, 0}, {20, 20});

  int taken = 0;
  for (int times = 0; times < 1000; ++times) taken += crowd.Takes({{0, 0}, {10, 0}}) ? 1 : 0;

  EXPECT_NEAR(taken, WallCrowd::kMostMmPerSquareMm, 5);
  EXPECT_FALSE(crowd.Takes({{5.5, 10}, {5.5, 0}})) << "ends where no room is";
  EXPECT_TRUE(crowd.Takes({{0, 10}, {10, 10}})) << "there is room elsewhere";
}

TEST(WallCrowd, CountsShortPiecesByTheirNumber) {
  WallCrowd crowd({0, 0}, {1, 1});

  int taken = 0;
  for (int i = 0; i < 10000; ++i) taken += crowd.Takes({{.5, .5}, {.5, .501}}) ? 1 : 0;

  EXPECT_LT(taken, 2000);
}

TEST(WallCrowd, ALineThatIsACrowdItselfIsRefusedAndTakesNoRoom) {
  WallCrowd crowd({0, 0}, {10, 10});
  std::vector<Point> to_and_fro;
  for (int i = 0; i < 1000; ++i) to_and_fro.push_back({i % 2 == 0 ? 0.0 : 10.0, 5});

  EXPECT_FALSE(crowd.Takes(to_and_fro));
  for (int i = 0; i < 30; ++i) EXPECT_TRUE(crowd.Takes({{0, 5}, {10, 5}}));
}

// Squares in one place, with travel moves past them: looking at all for each is what took long.
TEST(VisibleWalls, ThousandsInOnePlaceTakeNoLongerEach) {
  const auto measure = [](int squares) {
    std::string text = "M83\nG1 Z.2 F9000\n";
    for (int i = 0; i < squares; ++i) {
      text +=
          "G1 X14.5 Y16\nG1 X24.5 Y16 E1\nG1 X24.5 Y26 E1\nG1 X14.5 Y26 E1\nG1 X14.5 Y16 E1\n"
          "G1 X14.9 Y31\nG1 X16.9 Y31 E1\nG1 X16.9 Y33 E1\nG1 X14.9 Y33 E1\nG1 X14.9 Y31 E1\n";
    }
    const auto file = Read(text);
    const std::vector<Outline> outlines = OutlinesOf(*file, file->layers.front());
    MeasureLayers(*file, 1);
    EXPECT_LT(VisibleWallsOf(outlines).size(), 1000u);
    EXPECT_GT(VisibleWallsOf(outlines).size(), 20u);
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(2000, measure), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
