#include "client/gcode/plan/loop_stops.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "client/gcode/machine/motion_planner.h"
#include "engine/base/rng.h"

namespace traverse::gcode {
namespace {

constexpr Pace kPace = {120, 2000, 6};

double SecondsFrom(const std::vector<Vertex>& points, uint32_t vertex) {
  const size_t sides = points.size() - 1;
  MotionPlanner planner;
  for (size_t i = 0; i < sides; ++i) {
    const Vertex& from = points[(vertex + i) % sides];
    const Vertex& to = points[(vertex + i + 1) % sides];
    planner.Move(to.x - from.x, to.y - from.y, kPace.speed_mm_s, kPace.accel_mm_s2,
                 kPace.corner_speed);
  }
  planner.Stop();
  return planner.seconds();
}

// Around a circle of 20 mm, so that the machine gets going on each side of any stop.
std::vector<Vertex> Ragged(Rng& rng) {
  std::vector<Vertex> points;
  for (double turn = 0; turn < 2 * std::numbers::pi; turn += rng.Between(1, 40) / 100.0) {
    const double radius = 20 + rng.Between(0, 300) / 200.0;
    points.push_back({radius * std::cos(turn), radius * std::sin(turn)});
  }
  points.push_back(points.front());
  return points;
}

// A loop takes the same wherever it begins, but for the stop there.
TEST(LoopStops, DifferAsMuchAsThePlannedTimesOfTheLoop) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng(seed);
    const std::vector<Vertex> points = Ragged(rng);
    const LoopStops stops(points, kPace);
    const auto sides = static_cast<uint32_t>(points.size() - 1);
    for (uint32_t vertex = 0; vertex < sides; ++vertex) {
      const double differ = stops.Seconds(points, kPace, vertex) - stops.Seconds(points, kPace, 0);
      EXPECT_NEAR(differ, SecondsFrom(points, vertex) - SecondsFrom(points, 0), 2e-5)
          << "seed " << seed << ", vertex " << vertex;
    }
  }
}

TEST(LoopStops, CostLeastAtSharpCorners) {
  const std::vector<Vertex> points = {{0, 0}, {20, 0}, {40, 0}, {40, 40}, {0, 40}, {0, 0}};
  const LoopStops stops(points, kPace);

  const double straight_on = stops.Seconds(points, kPace, 1);
  const double corner = stops.Seconds(points, kPace, 2);

  EXPECT_NEAR(straight_on, kPace.speed_mm_s / kPace.accel_mm_s2, 1e-6);
  EXPECT_GT(corner, 0);
  EXPECT_LT(corner, straight_on / 10);
}

// Points twice in one place, no corner speed at all.
TEST(LoopStops, AreFiniteForOddLoops) {
  const std::vector<Vertex> points = {{0, 0}, {5, 0}, {5, 0}, {5, 5}, {0, 0}};
  for (const double corner_speed : {0.0, 1e6}) {
    const Pace pace = {100, 1000, corner_speed};
    const LoopStops stops(points, pace);
    for (uint32_t vertex = 0; vertex < 4; ++vertex) {
      const double seconds = stops.Seconds(points, pace, vertex);
      EXPECT_TRUE(std::isfinite(seconds));
      EXPECT_GE(seconds, 0);
    }
  }
}

}  // namespace
}  // namespace traverse::gcode
