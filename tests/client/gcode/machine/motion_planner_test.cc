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
  const double way = 50 - 5 - (100.0 * 100 - 25) / 2000;
  EXPECT_NEAR(Seconds(planner), 2 * (ramps + way / 100), 1e-9);
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

}  // namespace
}  // namespace traverse::gcode
