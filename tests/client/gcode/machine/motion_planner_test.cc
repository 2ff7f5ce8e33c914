#include "client/gcode/machine/motion_planner.h"

#include <gtest/gtest.h>

#include <cmath>

namespace traverse::gcode {
namespace {

double Seconds(MotionPlanner& planner) {
  planner.Stop();
  return planner.seconds();
}

TEST(StopToStopSeconds, FollowsTheTrapezoid) {
  // 100 mm/s at 1000 mm/s^2 takes 5 mm to reach and 5 mm to brake from.
  EXPECT_NEAR(StopToStopSeconds(30, 100, 1000), 0.1 + 0.1 + 0.2, 1e-12);
  EXPECT_NEAR(StopToStopSeconds(2.5, 100, 1000), 2 * std::sqrt(2.5 / 1000), 1e-12);
  EXPECT_EQ(StopToStopSeconds(0, 100, 1000), 0);
}

TEST(MotionPlanner, StraightOnTakesNoLongerInPieces) {
  MotionPlanner one;
  one.Move(100, 0, 100, 1000, 5);
  MotionPlanner many;
  for (int i = 0; i < 5000; ++i) many.Move(0.02, 0, 100, 1000, 5);

  EXPECT_NEAR(Seconds(many), Seconds(one), 1e-6);
}

TEST(MotionPlanner, SlowsToTheCornerSpeedAtARightAngle) {
  MotionPlanner planner;
  planner.Move(50, 0, 100, 1000, 5);
  planner.Move(0, 50, 100, 1000, 5);

  // Per leg: from 0 to 100, along, from 100 to 5 mm/s.
  const double ramps = 100.0 / 1000 + 95.0 / 1000;
  const double travel = 50 - 5 - (100.0 * 100 - 25) / 2000;
  EXPECT_NEAR(Seconds(planner), 2 * (ramps + travel / 100), 1e-9);
}

TEST(MotionPlanner, BrakesInTimeForWhatComes) {
  // Ten short moves to a stop: they cannot be faster than one braking move.
  MotionPlanner planner;
  planner.Move(50, 0, 100, 1000, 5);
  for (int i = 0; i < 10; ++i) planner.Move(0.1, 0, 100, 1000, 5);
  MotionPlanner one;
  one.Move(51, 0, 100, 1000, 5);

  EXPECT_NEAR(Seconds(planner), Seconds(one), 1e-9);
}

TEST(MotionPlanner, AStopCostsItsTime) {
  MotionPlanner planner;
  planner.Move(10, 0, 100, 1000, 5);
  planner.Stop(0.5);
  planner.Move(10, 0, 100, 1000, 5);

  EXPECT_NEAR(Seconds(planner), 0.5 + 2 * StopToStopSeconds(10, 100, 1000), 1e-9);
}

TEST(MotionPlanner, NonsenseTakesNoTime) {
  MotionPlanner planner;
  planner.Move(10, 0, 0, 1000, 5);
  planner.Move(0, 0, 100, 1000, 5);

  EXPECT_EQ(Seconds(planner), 0);
}

// Klipper's rules without a share of cruising and without an extruder.
constexpr PlannerRules kKlipper = {true, 0, 1e9};

TEST(MotionPlannerOfKlipper, TakesARightAngleAtTheCornerSpeed) {
  MotionPlanner usual;
  MotionPlanner klipper(kKlipper);
  for (MotionPlanner* planner : {&usual, &klipper}) {
    planner->Move(50, 0, 100, 1000, 5);
    planner->Move(0, 50, 100, 1000, 5);
  }

  EXPECT_NEAR(Seconds(klipper), Seconds(usual), 1e-9);
}

TEST(MotionPlannerOfKlipper, TakesAnotherAngleOnTheCircleThatMissesItByAsMuch) {
  // A turn of 60 degrees: cos 30 / (1 - cos 30) of 5^2 * (sqrt 2 - 1).
  MotionPlanner planner(kKlipper);
  planner.Move(50, 0, 100, 1000, 5);
  planner.Move(25, 25 * std::sqrt(3), 100, 1000, 5);

  const double half = std::sqrt(3) / 2;
  const double corner2 = half / (1 - half) * 25 * (std::sqrt(2) - 1);
  const double ramps = (200 - std::sqrt(corner2)) / 1000;
  const double travel = 50 - 5 - (100.0 * 100 - corner2) / 2000;
  EXPECT_NEAR(Seconds(planner), 2 * (ramps + travel / 100), 1e-9);
}

TEST(MotionPlannerOfKlipper, ShortMovesTakeCornersOnCirclesThatTouchTheirMiddles) {
  MotionPlanner planner(kKlipper);
  planner.Move(0.5, 0, 100, 1000, 20);
  planner.Move(0, 0.5, 100, 1000, 20);

  // The radius is 0.25 mm, so the corner is passed at the root of 250; each move peaks at 25.
  EXPECT_NEAR(Seconds(planner), 2 * (50 - std::sqrt(250)) / 1000, 1e-9);
}

TEST(MotionPlannerOfKlipper, TheExtruderHasItsOwnCornerSpeed) {
  MotionPlanner planner({true, 0, 1});
  MoveInSpace move{.dx = 50, .speed = 100, .accel = 1000, .machine_accel = 1000, .corner = 5};
  planner.Move(move);
  move.filament = 0.05;
  planner.Move(move);

  // From no filament to 0.05 mm a mm at once: 20 mm/s.
  const double ramps = (100 + 80) / 1000.0;
  const double travel = 50 - 5 - (100.0 * 100 - 400) / 2000;
  EXPECT_NEAR(Seconds(planner), 2 * (ramps + travel / 100), 1e-9);
}

// Z may accelerate by a tenth of what the machine does, and so takes the corner more slowly.
TEST(MotionPlannerOfKlipper, ALiftTakesTheCornerToTheTravelBehindItAsItsAxisAllows) {
  MotionPlanner planner(kKlipper);
  planner.Move({.dz = 0.5, .speed = 10, .accel = 100, .machine_accel = 1000, .corner = 5});
  planner.Move({.dx = 50, .speed = 100, .accel = 1000, .machine_accel = 1000, .corner = 5});

  // At the root of 5^2 / 10; the lift peaks at the root of 100 * 0.5 + 2.5 / 2.
  const double corner = std::sqrt(2.5);
  const double lift = (2 * std::sqrt(51.25) - corner) / 100;
  const double travel = (200 - corner) / 1000 + (50 - 5 - (10000 - 2.5) / 2000) / 100;
  EXPECT_NEAR(Seconds(planner), lift + travel, 1e-9);
}

TEST(MotionPlannerOfKlipper, LiftsInTheSameDirectionAreOne) {
  MotionPlanner one(kKlipper);
  one.Move({.dz = 2, .speed = 10, .accel = 100, .machine_accel = 1000, .corner = 5});
  MotionPlanner two(kKlipper);
  for (int i = 0; i < 2; ++i) {
    two.Move({.dz = 1, .speed = 10, .accel = 100, .machine_accel = 1000, .corner = 5});
  }

  EXPECT_NEAR(Seconds(two), Seconds(one), 1e-9);
}

// The share is one of the machine's acceleration: half of 1000 is more than the axis may anyway.
TEST(MotionPlannerOfKlipper, AnAxisThatIsSlowAnywayNeedsNoShareOfCruising) {
  MotionPlanner planner({true, 0.5, 1e9});
  planner.Move({.dz = 0.5, .speed = 100, .accel = 100, .machine_accel = 1000, .corner = 5});

  EXPECT_NEAR(Seconds(planner), StopToStopSeconds(0.5, 100, 100), 1e-9);
}

TEST(MotionPlannerOfKlipper, AShareOfAWayIsCruising) {
  MotionPlanner planner({true, 0.5, 1e9});
  planner.Move(10, 0, 1000, 1000, 5);

  const double peak = std::sqrt(5000);
  EXPECT_NEAR(Seconds(planner), 2 * peak / 1000 + 5 / peak, 1e-9);
}

TEST(MotionPlannerOfKlipper, TheShareMayChangeFromMoveToMove) {
  MotionPlanner planner({true, 0.5, 1e9});
  planner.Move(10, 0, 1000, 1000, 5);
  planner.set_cruise_ratio(0);
  planner.Move(-10, 0, 1000, 1000, 0);

  const double peak = std::sqrt(5000);
  EXPECT_NEAR(Seconds(planner), 2 * peak / 1000 + 5 / peak + StopToStopSeconds(10, 1000, 1000),
              1e-6);
}

TEST(MotionPlannerOfKlipper, SpeedThatIsReachedAnywayIsReachedAsSoon) {
  MotionPlanner planner({true, 0.5, 1e9});
  planner.Move(100, 0, 100, 1000, 5);

  EXPECT_NEAR(Seconds(planner), StopToStopSeconds(100, 100, 1000), 1e-9);
}

TEST(MotionPlannerOfKlipper, APeakHoldsOverAllMovesThatLeadUpToItAndDown) {
  MotionPlanner one({true, 0.5, 1e9});
  one.Move(100, 0, 400, 1000, 5);
  MotionPlanner many({true, 0.5, 1e9});
  for (int i = 0; i < 400; ++i) many.Move(0.25, 0, 400, 1000, 5);

  EXPECT_NEAR(Seconds(many), Seconds(one), 1e-6);
}

TEST(MotionPlannerOfKlipper, EachCornerBeginsAnotherPeak) {
  // Between right angles each move peaks by itself, whatever is beside it.
  MotionPlanner planner({true, 0.5, 1e9});
  for (int i = 0; i < 1000; ++i) planner.Move(i % 2 == 0 ? 4 : 0, i % 2 == 0 ? 0 : 4, 200, 1000, 5);

  // From 5 mm/s: 2 * 500 * 4 / 2 more of the square.
  const double peak = std::sqrt(25 + 2000);
  const double ramps = 2 * (peak - 5) / 1000;
  const double travel = 4 - (peak * peak - 25) / 1000;
  EXPECT_NEAR(Seconds(planner), 1000 * (ramps + travel / peak), 0.05);
}

}  // namespace
}  // namespace traverse::gcode
