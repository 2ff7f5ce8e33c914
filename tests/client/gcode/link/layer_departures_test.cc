// Short moves away from a path before its travel, as PrusaSlicer makes them: how a layer's writer
// estimates and writes them.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "client/gcode/gcode_job.h"
#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/gcode/write/layer_writer.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// A wall from whose end the file goes a little inwards before it leaves, two lines within it, and
// two beside it. Travel moves that cross no wall are not retracted.
class LayerWriterDepartures : public ::testing::Test {
 protected:
  LayerWriterDepartures() { Draw(.4, .4); }

  // With the end of the short move.
  void Draw(double x, double y) {
    Sketch sketch;
    sketch.Square(0, 0, 10).Go(x, y).Go(3, 3).Infill(3, 7).Go(5, 7).Infill(5, 3);
    sketch.GoRetracted(-2, -2).Infill(-2, -6).Go(-4, -6).Infill(-4, -2);
    file_ = sketch.Read();
    habit_ = HabitOfNewTravels(*file_);
    donors_.emplace(*file_);
    writer_.emplace(*file_, file_->layers[0], habit_, *donors_);
    given_ = writer_->GivenOrder();
  }

  // What the travel moves of `order` are estimated at, and what they come to.
  TravelTotals Estimated(const LayerOrder& order) const {
    TravelTotals sum;
    for (size_t i = 1; i < order.size(); ++i) {
      sum += writer_->EstimateTravel(i, order[i - 1], order[i]);
    }
    return sum;
  }
  PrintTotals Written(const LayerOrder& order) const {
    std::string text;
    const PartStart start = StartOfPaths(*file_, order.front());
    writer_->WritePaths(order, start, text);
    return Measure(*file_, text, start, &writer_->walls());
  }

  std::shared_ptr<GcodeFile> file_;
  RetractionHabit habit_;
  std::optional<LinkDonors> donors_;
  std::optional<LayerWriter> writer_;
  LayerOrder given_;
};

TEST_F(LayerWriterDepartures, AreNotMadeToTheOtherSideOfAWall) {
  ASSERT_NE(file_->blocks[1].link & kLinkDeparts, 0);
  // From the corner at which the wall ends straight to the lines beside it.
  const LayerOrder order = {given_[0], given_[3], given_[4], given_[1], given_[2]};

  EXPECT_EQ(Written(order).open_crossings, 0);
  EXPECT_EQ(Estimated(order).open, 0);
  EXPECT_NEAR(Estimated(order).mm, Written(order).travel_mm, .01);
}

// The end of a travel move lies too near to a wall to count; a bend of it may lie nearer.
TEST_F(LayerWriterDepartures, ThatEndNearAWallAreNotMadeAcrossIt) {
  Draw(.1, .3);
  const LayerOrder order = {given_[0], given_[3], given_[4], given_[1], given_[2]};

  EXPECT_NEAR(writer_->EstimateTravel(1, order[0], order[1]).mm, std::hypot(2, 2), .01);
  EXPECT_NEAR(Estimated(order).mm, Written(order).travel_mm, .01);
}

// What two paths lose that end and begin at a standstill, and not beside open travel.
constexpr double kStops = 2 * 20 / (2 * 1250.0);

TEST_F(LayerWriterDepartures, AreMadeWhereTheyAreOfUse) {
  const LayerOrder order = {given_[0], given_[2], given_[1], given_[3], given_[4]};

  EXPECT_NEAR(Written(order).travel_mm - Estimated(order).mm, 0, .01);
  const double straight = std::hypot(5, 7);
  const double bent = std::hypot(.4, .4) + std::hypot(4.6, 6.6);
  EXPECT_NEAR(writer_->EstimateTravel(1, given_[0], given_[2]).mm, bent, .001);
  EXPECT_GT(writer_->EstimateTravel(1, given_[0], given_[2]).seconds,
            StopToStopSeconds(straight, 150, 1250) - kStops);
}

// The square begins at its second corner: within it there, but not to the lines beside it.
TEST_F(LayerWriterDepartures, TurnWithTheStartOfTheLoop) {
  LayerOrder order = {given_[0], given_[2], given_[1], given_[3], given_[4]};
  order[0].entry = 1;
  std::string text;
  writer_->WritePaths(order, StartOfPaths(*file_, order.front()), text);

  EXPECT_NE(text.find("X9.600000 Y0.400000 F9000"), std::string::npos) << text;
  EXPECT_NEAR(Written(order).travel_mm - Estimated(order).mm, 0, .01);
  order = {order[0], given_[3], given_[4], given_[1], given_[2]};
  EXPECT_EQ(Written(order).open_crossings, 0);
  EXPECT_NEAR(Written(order).travel_mm - Estimated(order).mm, 0, .01);
}

TEST_F(LayerWriterDepartures, TakeTimeInTheFileToo) {
  const double straight = std::hypot(.4, .4) + std::hypot(2.6, 2.6);
  EXPECT_NEAR(writer_->EstimateTravel(1, given_[0], given_[1]).seconds,
              StopToStopSeconds(straight, 150, 1250) - kStops, .005);
}

// Inwards of the second corner lies another wall: there the move would cross it before filament is
// pulled back.
TEST(LayerWriter, DepartsFromALoopBegunElsewhereAcrossNoWall) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Go(.4, .4).GoRetracted(2, .2).Square(2, .2, 20);
  const auto file =
      sketch.GoRetracted(-2, 14).Infill(-2, 19).GoRetracted(-5, 19).Infill(-5, 14).Read();
  ASSERT_NE(file->blocks[1].link & kLinkDeparts, 0);
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const auto open = [&](uint32_t entry) {
    const LayerOrder order = {{0, entry, true}, {2, 0, false}, {1, 0, true}, {3, 0, false}};
    const PartStart start = StartOfPaths(*file, order.front());
    std::string text;
    writer.WritePaths(order, start, text);
    const TravelTotals estimated = writer.EstimateTravel(1, order[0], order[1]);
    EXPECT_EQ(estimated.open, 0);
    const bool departs = text.find("X9.600000 Y0.400000") != std::string::npos ||
                         text.find("X9.600000 Y9.600000") != std::string::npos;
    EXPECT_EQ(departs, entry == 2) << text;
    return Measure(*file, text, start, &writer.walls()).open_crossings;
  };
  EXPECT_EQ(open(1), 0);
  EXPECT_EQ(open(2), 0);
}

}  // namespace
}  // namespace traverse::gcode
