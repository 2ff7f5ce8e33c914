#include "client/gcode/plan/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using testing::Sketch;

// Printed at 20 mm/s, with the 1250 mm/s^2 and 5 mm/s of a file that states none.
struct JoinedLayer {
  explicit JoinedLayer(const Sketch& sketch)
      : file(sketch.Read()),
        outlines(OutlinesOf(*file, file->layers[0])),
        joints(*file, file->layers[0], outlines) {}

  const std::shared_ptr<GcodeFile> file;
  const std::vector<Outline> outlines;
  const LayerJoints joints;
};

void ExpectAlong(const Joint& joint, double x, double y) {
  EXPECT_NEAR(joint.along.x, x, 1e-9);
  EXPECT_NEAR(joint.along.y, y, 1e-9);
}

TEST(LayerJoints, OfALineLieInItsDirection) {
  const JoinedLayer layer(Sketch().Infill(10, 0));

  ExpectAlong(layer.joints.BeginOf(0, 0), 1, 0);
  ExpectAlong(layer.joints.EndOf(0, 0), 1, 0);
  ExpectAlong(layer.joints.BeginOf(0, 1), -1, 0);
  ExpectAlong(layer.joints.EndOf(0, 1), -1, 0);
  EXPECT_NEAR(layer.joints.EndOf(0, 1).speed_mm_s, 20, 1e-9);
  EXPECT_NEAR(layer.joints.EndOf(0, 1).accel_mm_s2, 1250, 1e-9);
}

TEST(LayerJoints, OfASquareAreThoseOfTheSidesAtItsStart) {
  const JoinedLayer layer(Sketch().Square(0, 0, 10));
  ASSERT_TRUE(layer.outlines[0].closed);

  ExpectAlong(layer.joints.BeginOf(0, 0), 1, 0);
  ExpectAlong(layer.joints.EndOf(0, 0), 0, -1);
  ExpectAlong(layer.joints.BeginOf(0, 1), 0, 1);
  ExpectAlong(layer.joints.EndOf(0, 1), 1, 0);
  ExpectAlong(layer.joints.BeginOf(0, 3), 0, -1);
  ExpectAlong(layer.joints.EndOf(0, 3), -1, 0);
}

TEST(LayerJoints, BehindACornerAShortSegmentIsTooShortToGetGoing) {
  const JoinedLayer layer(Sketch().Infill(10, 0).Infill(10, .05));
  ASSERT_EQ(layer.outlines.size(), 1u);

  // 5 mm/s at a right angle, and 0.05 mm from there.
  EXPECT_NEAR(layer.joints.EndOf(0, 0).speed_mm_s, std::sqrt(25 + 2 * 1250 * .05), 1e-6);
  EXPECT_NEAR(layer.joints.BeginOf(0, 0).speed_mm_s, 20, 1e-9);
}

TEST(StopSeconds, AreWhatGettingGoingLoses) {
  EXPECT_NEAR(StopSeconds({{1, 0}, 20, 1250}), .008, 1e-12);
  EXPECT_EQ(StopSeconds({}), 0);
}

constexpr TravelModel kTravel = {.speed_mm_s = 100, .accel_mm_s2 = 1000};
constexpr double kTurnBack = -1;

// Of a travel move of 20 mm along x, joined to paths that lead along (x, 0).
double JoinedSeconds(double x) {
  const std::shared_ptr<GcodeFile> file = Sketch().Infill(10, 0).Read();
  PlannedTravel travel;
  travel.from = {10, 0};
  travel.to = {30, 0};
  const Joint joint{{x, 0}, 20, 1250};
  const TravelJoints joints{joint, joint};
  return NewTravelSeconds(*file, 0, travel, kTravel, &joints);
}

TEST(NewTravelSeconds, StraightOnNothingIsLost) {
  // From 20 mm/s up to 100 and down again.
  const double ramps_mm = (100.0 * 100 - 20 * 20) / 1000;

  EXPECT_NEAR(JoinedSeconds(1), 2 * (100.0 - 20) / 1000 + (20 - ramps_mm) / 100, 1e-9);
}

TEST(NewTravelSeconds, TurningBackLosesNearlyWhatAStopDoes) {
  const double stop = StopToStopSeconds(20, 100, 1000) + 2 * StopSeconds({{1, 0}, 20, 1250});

  EXPECT_LT(JoinedSeconds(kTurnBack), stop);
  EXPECT_GT(JoinedSeconds(kTurnBack), stop - .015);
}

// Straight on a way takes less than it would with printing stopped.
TEST(TravelSeconds, JoinThePathsLikeNewOnes) {
  const std::shared_ptr<GcodeFile> file = Sketch().Infill(10, 0).Go(30, 0).Infill(40, 0).Read();
  const Joint joint{{1, 0}, 20, 1250};
  const TravelJoints joints{joint, joint};

  EXPECT_NEAR(TravelSeconds(*file, 1, kTravel, true, &joints), JoinedSeconds(1), 1e-9);
}

// Joined as where nothing is retracted, but for the stops: at the end of the move inwards, which
// leads straight on from the path, and before the next path.
TEST(TravelSeconds, StopForARetractionLikeNewOnes) {
  Sketch sketch;
  sketch.Infill(10, 0).Go(10.4, 0).Add("G1 E-.8 F2100").Go(30, 0).Add("G1 E.8 F2100");
  const std::shared_ptr<GcodeFile> file = sketch.Infill(40, 0).Read();
  const Joint joint{{1, 0}, 20, 1250};
  const TravelJoints joints{joint, joint};
  PlannedTravel travel;
  travel.ahead = {.4, 0};
  travel.from = {10.4, 0};
  travel.to = {30, 0};
  travel.retracts = true;

  const double seconds = TravelSeconds(*file, 1, kTravel, true, &joints);
  EXPECT_NEAR(seconds, NewTravelSeconds(*file, 0, travel, kTravel, &joints), 1e-9);
  // The path is left at 20 mm/s, which end with the move inwards.
  const double stops = 2 * StopSeconds(joint) + StopToStopSeconds(.4, 100, 1000);
  EXPECT_LT(seconds, StopToStopSeconds(19.6, 100, 1000) + stops);
  EXPECT_GT(seconds, StopToStopSeconds(19.6, 100, 1000) + StopSeconds(joint));
}

TEST(NewTravelSeconds, ARetractionAtOnceStopsAtBothPaths) {
  const std::shared_ptr<GcodeFile> file = Sketch().Infill(10, 0).Read();
  const Joint joint{{1, 0}, 20, 1250};
  const TravelJoints joints{joint, joint};
  PlannedTravel travel;
  travel.from = {10, 0};
  travel.to = {30, 0};
  travel.retracts = true;
  const double straight = StopToStopSeconds(20, 100, 1000) + 2 * StopSeconds(joint);

  EXPECT_NEAR(NewTravelSeconds(*file, 0, travel, kTravel, &joints), straight, 1e-9);
  travel.via = {{20, 0}};
  EXPECT_NEAR(NewTravelSeconds(*file, 0, travel, kTravel, &joints), straight, 1e-6);
}

// Both travel moves are of the same length and angle: between them is what the loop takes by
// itself.
TEST(LayerJoints, ALoopBegunStraightOnTakesLongerByItsStop) {
  Sketch sketch;
  sketch.Add("G1 F9000").Square(0, 0, 30);
  const JoinedLayer square(sketch);
  ASSERT_TRUE(square.outlines[0].closed);
  for (uint32_t corner = 0; corner < 4; ++corner) {
    EXPECT_NEAR(square.joints.RestartSeconds(0, corner), 0, 1e-9);
  }

  // Begun at a corner, and at the middle of a side.
  Sketch drawn;
  drawn.Add(";TYPE:External perimeter");
  for (const char* to : {"X15 Y0", "X30 Y0", "X30 Y30", "X0 Y30", "X0 Y0"}) {
    drawn.Add(std::string("G1 ") + to + " E.5 F1200");
  }
  const JoinedLayer layer(drawn);
  ASSERT_TRUE(layer.outlines[0].closed);
  const auto stops = [&](uint32_t entry) {
    return StopSeconds(layer.joints.EndOf(0, entry)) + StopSeconds(layer.joints.BeginOf(0, entry));
  };
  EXPECT_NEAR(stops(0), stops(1), 1e-9);
  EXPECT_NEAR(layer.joints.RestartSeconds(0, 2), 0, 1e-6);
  // The corner at its old start slows it down now as it did not before, by 20 - 5 mm/s.
  EXPECT_NEAR(layer.joints.RestartSeconds(0, 1), 2 * 15 * 15 / (2 * 1250.0 * 20), 1e-6);
  EXPECT_EQ(layer.joints.RestartSeconds(0, 0), 0);
}

}  // namespace
}  // namespace traverse::gcode
