// What a layer's writer says of a way before it writes it.

#include "client/gcode/write/layer_writer.h"

#include <gtest/gtest.h>

#include "client/gcode/plan/travel_rules.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// What the way from a square to the second of three lines beside it comes to. Inside an island ways
// are not retracted.
WayTotals FromSquareToLine(bool goes_on) {
  Sketch sketch;
  sketch.Square(0, 0, 10);
  if (goes_on) sketch.Go(.3, 0);
  sketch.Go(-1, 5).Infill(-1, 9).Go(-3, 9).Infill(-3, 5).Go(-5, 5).Infill(-5, 9);
  const auto file = sketch.GoRetracted(30, 5).Square(30, 5, 10).Read();
  EXPECT_EQ((file->blocks[0].flags & kBlockGoesOn) != 0, goes_on);
  const RetractionHabit habit = HabitOfNewWays(*file);
  EXPECT_TRUE(habit.crossing_matters);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder given = writer.GivenOrder();
  return writer.EstimateWay(1, given[0], given[2], TravelModel());
}

// Behind the end of a wall the nozzle goes on along it, and is then on the other side of a corner.
TEST(LayerWriter, RetractsForAWayThatCrossesAWallFromWhereThePathGoesOnTo) {
  EXPECT_EQ(FromSquareToLine(false).retractions, 0);
  EXPECT_EQ(FromSquareToLine(true).retractions, 1);
  EXPECT_EQ(FromSquareToLine(true).open, 0);
}

}  // namespace
}  // namespace traverse::gcode
