// What a layer's writer says of a way before it writes it.

#include "client/gcode/write/layer_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/layer_meter.h"
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

// A line that is wiped behind its end, back over 2 of its 10 mm, and one that is not.
class LayerWriterWipes : public ::testing::Test {
 protected:
  LayerWriterWipes() {
    Sketch sketch;
    sketch.Square(0, 0, 60).GoRetracted(10, 10).Infill(20, 10);
    sketch.Add(";WIPE_START").Add("G1 X18 Y10 E-.8 F2400").Add(";WIPE_END");
    sketch.Go(10, 20).Add("G1 E.8 F2100").Infill(20, 20).GoRetracted(10, 30).Infill(20, 30);
    file_ = sketch.GoRetracted(10, 40).Infill(20, 40).Read();
    habit_ = HabitOfNewWays(*file_);
  }

  WayTotals Estimate(const Placement& from, const Placement& to) const {
    const LinkDonors donors(*file_);
    return LayerWriter(*file_, file_->layers[0], habit_, donors)
        .EstimateWay(3, from, to, TravelModel());
  }

  std::shared_ptr<GcodeFile> file_;
  RetractionHabit habit_;
};

TEST_F(LayerWriterWipes, AWayBeginsWhereTheWipeBeforeItEnds) {
  ASSERT_TRUE(file_->WipedBehind(1));

  // From (18, 10), and from (12, 10) where the line is done the other way round.
  const WayTotals on = Estimate({1, 0, false}, {3, 0, false});
  const WayTotals back = Estimate({1, 1, false}, {3, 0, false});

  EXPECT_NEAR(on.mm, 2 + std::hypot(8, 20), 1e-3);
  EXPECT_NEAR(back.mm, 2 + std::hypot(2, 20), 1e-3);
  EXPECT_LT(back.seconds, on.seconds);
  // A wipe takes as long wherever the way leads.
  EXPECT_NEAR(on.seconds, StopToStopSeconds(std::hypot(8, 20), 150, 1250), 1e-6);
  EXPECT_EQ(on.retractions, 1);
  // The other direction knows nothing of a wipe.
  EXPECT_NEAR(Estimate({3, 0, false}, {1, 0, false}).mm, std::hypot(10, 20), 1e-3);
}

// The estimate is what is written, for ways that begin with a wipe and for others.
TEST_F(LayerWriterWipes, WaysAreAsLongAsTheyAreWritten) {
  const LinkDonors donors(*file_);
  const LayerWriter writer(*file_, file_->layers[0], habit_, donors);
  for (const LayerOrder& order :
       {LayerOrder{{0, 0, true}, {3, 0, false}, {1, 1, false}, {2, 0, false}, {4, 0, false}},
        LayerOrder{{0, 0, true}, {1, 0, false}, {3, 1, false}, {2, 1, false}, {4, 0, false}}}) {
    std::string text;
    const PartStart start = StartOfPaths(*file_, order.front());
    writer.WritePaths(order, start, text);
    WayTotals ways;
    for (size_t i = 1; i < order.size(); ++i) {
      ways += writer.EstimateWay(i, order[i - 1], order[i], TravelModel());
    }

    EXPECT_NEAR(ways.mm, Measure(*file_, text, start).travel_mm, 1e-3);
  }
}

}  // namespace
}  // namespace traverse::gcode
