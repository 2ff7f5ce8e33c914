#include "client/gcode/plan/travel_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "client/gcode/machine/motion_planner.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

constexpr TravelModel kUsualTravel = {.speed_mm_s = 100, .accel_mm_s2 = 1000};

TEST(TravelSeconds, OfAStraightTravelAreThoseFromStandstillToStandstill) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(0, 10).Infill(10, 10).GoRetracted(20, 10).Infill(30, 10);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_EQ(file->blocks.size(), 3u);

  EXPECT_NEAR(TravelSeconds(*file, 1, kUsualTravel), StopToStopSeconds(std::sqrt(200), 100, 1000),
              1e-6);
  EXPECT_NEAR(TravelSeconds(*file, 2, kUsualTravel), StopToStopSeconds(10, 100, 1000), 1e-6);
}

TEST(TravelSeconds, BendsTakeTimeAsLongAsNobodyStopsThere) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(10, 20).Go(30, 20).Infill(30, 30);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_EQ(file->blocks.size(), 2u);

  EXPECT_GT(TravelSeconds(*file, 1, kUsualTravel), StopToStopSeconds(40, 100, 1000) + 0.01);
  EXPECT_LT(TravelSeconds(*file, 1, kUsualTravel), 2 * StopToStopSeconds(20, 100, 1000));
}

// Other travel moves from the same path begin with it too; where none is read, it is a bend.
TEST(TravelSeconds, AreWithoutTheShortMoveInwards) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(10, .5).Go(40, .5).Infill(50, .5);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_NE(file->blocks[1].link & kLinkDeparts, 0);

  EXPECT_NEAR(TravelSeconds(*file, 1, kUsualTravel), StopToStopSeconds(30, 100, 1000), 1e-6);
  file->blocks[1].link &= static_cast<uint16_t>(~kLinkDeparts);
  EXPECT_GT(TravelSeconds(*file, 1, kUsualTravel), StopToStopSeconds(30, 100, 1000) + 0.02);
}

// What the stop costs there is a part of the travel and of the price, and not of the retraction.
TEST(LearnTravel, ARetractionDoesNotPayForTheStopBehindTheMoveInwards) {
  const auto learnt = [](double inwards) {
    Sketch sketch;
    sketch.Infill(10, 0).Go(10 + inwards, 0).Add("G1 E-.8 F2100").Go(50, 0).Add("G1 E.8 F2100");
    const std::shared_ptr<GcodeFile> file = sketch.Infill(60, 0).Infill(60, 1).Read();
    return LearnTravel(*file)[0];
  };
  const TravelModel at_once = learnt(0);
  const TravelModel behind = learnt(.4);
  EXPECT_GT(at_once.retraction_seconds, 0);
  EXPECT_EQ(at_once.retraction_price, at_once.retraction_seconds);
  EXPECT_NEAR(behind.retraction_seconds, at_once.retraction_seconds, 1e-9);
  EXPECT_GT(behind.retraction_price, behind.retraction_seconds + .01);
}

// A wipe is a move as any other one: the machine has to get going for it.
TEST(LearnTravel, RetractionsTakeTheTimeThatTheyAddToTravel) {
  Sketch sketch;
  sketch.Infill(10, 0).Add("G1 E-.4 F2100").Add("G1 X5 Y0 E-.4 F7200").Go(0, 10);
  sketch.Add("G1 E.8 F2100").Infill(10, 10).Go(0, 20).Infill(10, 20);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_EQ(file->layers.size(), 1u);

  const std::vector<TravelModel> models = LearnTravel(*file);

  ASSERT_EQ(models.size(), 1u);
  const double still = 1.2 / 35;
  EXPECT_GT(models[0].retraction_seconds, still + 5.0 / 120 + 0.01);
  EXPECT_LT(models[0].retraction_seconds,
            still + 2 * StopToStopSeconds(5, 120, models[0].accel_mm_s2));
  EXPECT_EQ(models[0].speed_mm_s, 150);
}

// Where the filament is changed beside other travel.
TEST(LearnTravel, FewThatLastFarLongerTellNothingOfTheOthers) {
  const auto learn = [](const std::string& change) {
    Sketch sketch;
    sketch.Infill(10, 0);
    for (int y = 10; y < 60; y += 10) sketch.GoRetracted(0, y).Infill(10, y);
    sketch.Add("G1 E-.8 F2100").Add(change).Go(0, 90).Add("G1 E.8 F2100").Infill(10, 90);
    const std::shared_ptr<GcodeFile> file = sketch.Read();
    EXPECT_EQ(file->blocks.size(), 7u);
    return LearnTravel(*file)[0].retraction_seconds;
  };
  const double usual = learn("M73 P1");
  EXPECT_GT(usual, 0.02);
  EXPECT_NEAR(learn("G1 E-15 F300\nG1 E15 F300"), usual, 1e-6);
}

// Behind a mark filament may be loaded, or waited for.
TEST(LearnTravel, RetractionsAtMarksTellNothingOfTheOthers) {
  Sketch sketch;
  sketch.Infill(10, 0).GoRetracted(0, 10).Infill(10, 10);
  sketch.Add("G1 E-.8 F2100").Add("; printing object b").Add("G1 E-15 F300").Add("G1 E15 F300");
  sketch.Go(0, 20).Add("G1 E.8 F2100").Infill(10, 20);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_EQ(file->layers.size(), 1u);
  ASSERT_EQ(file->blocks.size(), 3u);
  ASSERT_NE(file->blocks[2].link & kLinkSplits, 0);

  EXPECT_LT(LearnTravel(*file)[0].retraction_seconds, 0.2);
}

// Better a rough price than none.
TEST(LearnTravel, RetractionsAtMarksCountWhereThereAreNoOthers) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(0, 10).Infill(10, 10);
  sketch.Add("G1 E-.8 F2100").Add("; printing object b").Go(0, 20).Add("G1 E.8 F2100");
  sketch.Infill(10, 20);
  const std::shared_ptr<GcodeFile> file = sketch.Read();
  ASSERT_NE(file->blocks[2].link & kLinkSplits, 0);

  EXPECT_GT(LearnTravel(*file)[0].retraction_seconds, 0.04);
}

}  // namespace
}  // namespace traverse::gcode
