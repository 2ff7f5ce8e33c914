// What a layer's writer says of a travel move before it writes it.

#include "client/gcode/write/layer_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "client/gcode/gcode_job.h"
#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/input/input_job.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// A loop that ends .1 mm short of its start does so wherever it begins, and the next travel is
// longer.
TEST(LayerWriter, CountsAWayFromWhereALoopBegunElsewhereEnds) {
  Sketch sketch;
  sketch.Add(";TYPE:External perimeter").Add("G1 X10 Y0 E.4 F1200").Add("G1 X10 Y10 E.4");
  sketch.Add("G1 X0 Y10 E.4").Add("G1 X0 Y.1 E.396");
  const auto file = sketch.Go(12, 0).Infill(15, 0).Go(15, 5).Infill(20, 5).Read();
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder order = {{0, 1, true}, {1, 0, false}, {2, 0, false}};
  std::string text;
  const PartStart start = StartOfPaths(*file, order.front());

  writer.WritePaths(order, start, text);

  EXPECT_NEAR(writer.EstimateTravel(1, order[0], order[1]).mm, 2.1, 1e-6) << text;
  EXPECT_NEAR(Measure(*file, text, start).travel_mm, 2.1 + 5, 1e-6) << text;
}

// No travel of the file is open, and the second line begins where the third ends: no way to go.
TEST(LayerWriter, NothingIsRetractedWhereThereIsNoTravelToGo) {
  Sketch sketch;
  sketch.Infill(5, 0).GoRetracted(10, 5).Infill(10, 9).GoRetracted(20, 5).Infill(10, 5);
  const auto file = sketch.GoRetracted(30, 5).Infill(40, 5).Read();
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder order = {{0, 0, false}, {2, 0, false}, {1, 0, false}, {3, 0, false}};
  std::string text;
  const PartStart start = StartOfPaths(*file, order.front());

  writer.WritePaths(order, start, text);

  EXPECT_EQ(writer.EstimateTravel(2, order[1], order[2]).retractions, 0) << text;
  EXPECT_EQ(Measure(*file, text, start).retractions, 2) << text;
}

// What the travel from a square to the second of three lines beside it comes to. Inside an island
// travel moves are not retracted.
TravelTotals FromSquareToLine(bool goes_on) {
  Sketch sketch;
  sketch.Square(0, 0, 10);
  if (goes_on) sketch.Go(.3, 0);
  sketch.Go(-1, 5).Infill(-1, 9).Go(-3, 9).Infill(-3, 5).Go(-5, 5).Infill(-5, 9);
  const auto file = sketch.GoRetracted(30, 5).Square(30, 5, 10).Read();
  EXPECT_EQ((file->blocks[0].flags & kBlockGoesOn) != 0, goes_on);
  const RetractionHabit habit = HabitOfNewTravels(*file);
  EXPECT_TRUE(habit.crossing_matters);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder given = writer.GivenOrder();
  return writer.EstimateTravel(1, given[0], given[2]);
}

// Behind the end of a wall the nozzle goes on along it, and is then on the other side of a corner.
TEST(LayerWriter, RetractsForAWayThatCrossesAWallFromWhereThePathGoesOnTo) {
  EXPECT_EQ(FromSquareToLine(false).retractions, 0);
  EXPECT_EQ(FromSquareToLine(true).retractions, 1);
  EXPECT_EQ(FromSquareToLine(true).open, 0);
}

// Where nothing is retracted, the head leaves the path without a stop: straight on the fastest.
TEST(LayerWriter, AWayStraightOnTakesLessTimeThanOneRoundACorner) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(12, 0).Infill(20, 0).Go(20, 2).Infill(28, 2);
  const auto file = sketch.Read();
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder given = writer.GivenOrder();

  const double straight = writer.EstimateTravel(1, given[0], given[1]).seconds;
  const double bent = writer.EstimateTravel(2, given[1], given[2]).seconds;

  EXPECT_LT(straight, bent - .01);
}

// Before a wipe the move inwards is of the path, and before the marks of a layer.
TEST(LayerWriter, PathsAreLeftAsInTheFile) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Add("G1 X.3 Y.3 F9000").GoRetracted(30, 5).Infill(30, 9);
  sketch.GoRetracted(20, 5).Square(20, 5, 5).Add("G1 X20.2 Y5.2 F9000").Add(";WIPE_START");
  sketch.Add("G1 X22 Y5 E-.8 F2400").Add(";WIPE_END").Go(40, 5).Add("G1 E.8 F2100");
  sketch.Infill(40, 9).GoRetracted(50, 5).Infill(50, 9);
  sketch.Add("G1 X50.2 Y9.2 F9000").Add("G1 E-.8 F2100").Add(";LAYER_CHANGE");
  sketch.Add("G1 Z.4 F9000").Go(0, 0);
  const auto file = sketch.Add("G1 E.8 F2100").Infill(9, 0).Read();
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  const LayerOrder given = writer.GivenOrder();
  const LayerOrder order = {given[1], given[2], given[4], given[3], given[0]};
  std::string text;
  const PartStart behind = writer.WritePaths(order, StartOfPaths(*file, order.front()), text);
  const LayerWriter next(*file, file->layers[1], habit, donors);
  next.WriteTravel(order.back(), next.GivenOrder().front(), behind, text);

  EXPECT_NE(text.find("X.3 Y.3 F9000\nG1 E-.8"), std::string::npos) << text;
  EXPECT_NE(text.find("G1 X50.2 Y9.2 F9000\n;WIPE_START"), std::string::npos) << text;
  EXPECT_NE(text.find("X20.2 Y5.2 F9000\n;WIPE_START"), std::string::npos) << text;
}

// The same from other starts; a wipe returns to the loop behind its gap.
TEST(LayerWriter, LoopsBegunElsewhereAreLeftAsInTheFile) {
  const auto loop = [](Sketch& sketch, const std::string& gap) -> Sketch& {
    sketch.Add(";TYPE:External perimeter").Add("G1 X10 Y0 E.4 F1200").Add("G1 X10 Y10 E.4");
    return sketch.Add("G1 X0 Y10 E.4").Add("G1 X0 Y" + gap + " E.396").Add("G1 X.3 Y.2 F9000");
  };
  Sketch sketch;
  loop(sketch, ".1").GoRetracted(4, 5).Infill(4, 9).GoRetracted(0, 0);
  loop(sketch, ".1").Add(";WIPE_START").Add("G1 X2 Y0 E-.8 F2400").Add(";WIPE_END");
  const auto file = sketch.Go(40, 5).Add("G1 E.8 F2100").Infill(40, 9).Read();
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  LayerOrder order = writer.GivenOrder();
  order[0].entry = 2;
  order[2].entry = 1;
  std::string text;
  writer.WritePaths(order, StartOfPaths(*file, order.front()), text);

  EXPECT_NE(text.find("X9.700000 Y9.800000 F9000\nG1 E-.8"), std::string::npos) << text;
  EXPECT_NE(text.find("X9.800000 Y.300000 F9000\n;WIPE_START\nG1 F2400 X10.000000 Y2.000000"),
            std::string::npos)
      << text;
}

// Where the nozzle goes on along a path behind its end, that is of the path, wherever the next one
// lies.
TEST(LayerWriter, WhatGoesOnAlongAPathIsWrittenBeforeNewTravel) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Go(.3, 0).Go(-1, 5).Infill(-1, 9).Go(-3, 9).Infill(-3, 5);
  sketch.Go(-5, 5).Infill(-5, 9).GoRetracted(30, 5).Infill(30, 9);
  const auto file = sketch.Read();
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  LayerOrder order = writer.GivenOrder();
  std::swap(order[1], order[2]);
  std::string text;
  writer.WritePaths(order, StartOfPaths(*file, order.front()), text);

  EXPECT_NE(text.find("X0.300000 Y0.000000 F9000"), std::string::npos) << text;
}

// A line that is wiped behind its end, back over 2 of its 10 mm, and one that is not.
class LayerWriterWipes : public ::testing::Test {
 protected:
  // `departure`: a line between the path and its wipe.
  explicit LayerWriterWipes(const char* departure = "") {
    Sketch sketch;
    sketch.Square(0, 0, 60).GoRetracted(10, 10).Infill(20, 10).Add(departure);
    sketch.Add(";WIPE_START").Add("G1 X18 Y10 E-.8 F2400").Add(";WIPE_END");
    sketch.Go(10, 20).Add("G1 E.8 F2100").Infill(20, 20).GoRetracted(10, 30).Infill(20, 30);
    file_ = sketch.GoRetracted(10, 40).Infill(20, 40).Read();
    habit_ = HabitOfNewTravels(*file_);
  }

  TravelTotals Estimate(const Placement& from, const Placement& to) const {
    const LinkDonors donors(*file_);
    return LayerWriter(*file_, file_->layers[0], habit_, donors).EstimateTravel(3, from, to);
  }

  // The estimate is what is written, for travel moves that begin with a wipe and for others.
  void ExpectTravelsAsLongAsWritten() const {
    const LinkDonors donors(*file_);
    const LayerWriter writer(*file_, file_->layers[0], habit_, donors);
    for (const LayerOrder& order :
         {LayerOrder{{0, 0, true}, {3, 0, false}, {1, 1, false}, {2, 0, false}, {4, 0, false}},
          LayerOrder{{0, 0, true}, {1, 0, false}, {3, 1, false}, {2, 1, false}, {4, 0, false}}}) {
      std::string text;
      const PartStart start = StartOfPaths(*file_, order.front());
      writer.WritePaths(order, start, text);
      TravelTotals travels;
      for (size_t i = 1; i < order.size(); ++i) {
        travels += writer.EstimateTravel(i, order[i - 1], order[i]);
      }

      EXPECT_NEAR(travels.mm, Measure(*file_, text, start).travel_mm, 1e-3) << text;
    }
  }

  std::shared_ptr<GcodeFile> file_;
  RetractionHabit habit_;
};

class LayerWriterWipesBehindDepartures : public LayerWriterWipes {
 protected:
  LayerWriterWipesBehindDepartures() : LayerWriterWipes("G1 X20.3 Y10.4 F9000") {}
};

// What the head does where an object's label stands it does in any order: only the travel between
// the paths counts. (Orca's visits to a wipe tower seemed to be time to save.)
TEST(LayerWriter, CountsOfAWayPastALabelWhatLiesBetweenThePaths) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Go(20, 0).Infill(30, 0).Add("; printing object a").Go(300, 300);
  sketch.Go(20, 5).Infill(30, 5).Go(20, 10).Infill(30, 10);
  const auto file = sketch.Read();
  ASSERT_EQ(file->blocks[2].link & (kLinkSplits | kLinkFixed), kLinkSplits);
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);

  const TravelTotals as_given = writer.EstimateTravel(2, {1, 0, false}, {2, 0, false});
  const TravelTotals turned = writer.EstimateTravel(2, {1, 1, false}, {2, 0, false});

  EXPECT_NEAR(as_given.mm, std::hypot(10, 5), 1e-3);
  EXPECT_NEAR(turned.mm, 5, 1e-3);
  const v1::Layer told = MakeGcodeJob(file, {}).layers[0];
  EXPECT_LT(told.known_moves(1).seconds(), 0.5);
}

// The travel begins where lines that stay leave the head, whatever is printed before them.
TEST(LayerWriter, CountsOfAWayBehindAScriptWhatFollowsIt) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Go(20, 0).Infill(30, 0).Go(60, 5).Add("FLUSH_IT");
  sketch.Go(20, 5).Infill(30, 5).Go(20, 10).Infill(30, 10);
  const auto file = sketch.Read();
  ASSERT_NE(file->blocks[2].link & kLinkFixedFrom, 0);
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LinkDonors donors(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);

  const TravelTotals as_given = writer.EstimateTravel(2, {1, 0, false}, {2, 0, false});
  const TravelTotals turned = writer.EstimateTravel(2, {1, 0, false}, {2, 1, false});

  EXPECT_NEAR(as_given.mm, 40, 1e-3);
  EXPECT_NEAR(turned.mm, std::hypot(30, 0), 1e-3);
}

TEST_F(LayerWriterWipes, AWayBeginsWhereTheWipeBeforeItEnds) {
  ASSERT_TRUE(file_->WipedBehind(1));

  // From (18, 10), and from (12, 10) where the line is done the other way round.
  const TravelTotals on = Estimate({1, 0, false}, {3, 0, false});
  const TravelTotals back = Estimate({1, 1, false}, {3, 0, false});

  EXPECT_NEAR(on.mm, 2 + std::hypot(8, 20), 1e-3);
  EXPECT_NEAR(back.mm, 2 + std::hypot(2, 20), 1e-3);
  EXPECT_LT(back.seconds, on.seconds);
  // A wipe takes as long wherever the travel leads, but for the corner between the two.
  const double shorter = StopToStopSeconds(std::hypot(8, 20), 150, 1250) -
                         StopToStopSeconds(std::hypot(2, 20), 150, 1250);
  EXPECT_NEAR(on.seconds - back.seconds, shorter, .005);
  EXPECT_EQ(on.retractions, 1);
  // The other direction knows nothing of a wipe.
  EXPECT_NEAR(Estimate({3, 0, false}, {1, 0, false}).mm, std::hypot(10, 20), 1e-3);
}

TEST_F(LayerWriterWipes, TravelsAreAsLongAsTheyAreWritten) { ExpectTravelsAsLongAsWritten(); }

TEST_F(LayerWriterWipesBehindDepartures, TravelsAreAsLongAsTheyAreWritten) {
  ASSERT_TRUE(file_->WipedBehind(1));
  ExpectTravelsAsLongAsWritten();
}

// Or orders that change nothing else would seem to save time.
TEST_F(LayerWriterWipesBehindDepartures, CostNewTravelsTimeToo) {
  const double new_travel = Estimate({1, 0, false}, {3, 0, false}).seconds;

  constexpr double kStopSeconds = 20 / (2 * 1250.0);  // of the path behind it
  EXPECT_GT(new_travel, StopToStopSeconds(std::hypot(8, 20), 150, 1250) + kStopSeconds + 0.003);
}

}  // namespace
}  // namespace traverse::gcode
