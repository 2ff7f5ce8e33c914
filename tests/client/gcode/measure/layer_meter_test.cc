// Travel, time and filament of layers: client/gcode/measure/layer_meter.h.

#include "client/gcode/measure/layer_meter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "absl/strings/str_format.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/samples.h"
#include "tests/client/gcode/support/scattered_lines.h"
#include "tests/client/gcode/support/sketch.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small files

// Wipes pull back in several moves, each of them rounded.
TEST(Measure, WhatRoundingLosesOfAWipeIsNotPushedBeyondIt) {
  const auto file = Read(kScattered);
  const Block& first = file->blocks.front();
  const PartStart start{StateAt(*file, first), file->states[first.state_in]};

  EXPECT_EQ(Measure(*file, "G1 E-.17001\nG1 E-.62998\nG1 E.8\n", start).extra_mm, 0);
  EXPECT_NEAR(Measure(*file, "G1 E-.17001\nG1 E-.62998\nG1 E.82\n", start).extra_mm, 0.02, 1e-4);
  EXPECT_NEAR(Measure(*file, "G1 E.00005\n", start).extra_mm, 5e-5, 1e-9);
  // Short of it, where that is a priming.
  EXPECT_NEAR(Measure(*file, "G1 E-.8\nG1 E.79\n", start).extra_mm, -0.01, 1e-9);
  EXPECT_EQ(Measure(*file, "G1 E-.8\nG1 E.4\nG1 E.4\n", start).extra_mm, 0);
}

double SecondsOfMove(const MachineProfile& profile, const std::string& setter) {
  const auto file = Read(kScattered);
  file->profile = profile;
  const Block& first = file->blocks.front();
  const PartStart start{StateAt(*file, first), file->states[first.state_in]};
  const Position& at = start.machine.at;
  return Measure(*file, setter + absl::StrFormat("\nG1 X%g F60000\n", ToDouble(at.x) + 10), start)
      .seconds;
}

// From standstill to standstill, as Klipper's own planner has it.
TEST(Measure, KlippersShareOfCruisingMayBeSetInAFile) {
  MachineProfile klipper;
  klipper.klipper = true;
  klipper.print_accel = klipper.travel_accel = 1000;
  const auto seconds = [&klipper](double ratio) {
    return SecondsOfMove(klipper,
                         absl::StrFormat("SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=%g", ratio));
  };
  const auto expected = [](double ratio) {
    const double peak = std::sqrt((1 - ratio) * 1000 * 10);
    return 2 * peak / 1000 + ratio * 10 / peak;
  };

  EXPECT_NEAR(seconds(0), expected(0), 1e-6);
  EXPECT_NEAR(seconds(0.5), expected(0.5), 1e-6);
  EXPECT_NEAR(seconds(0.8), expected(0.8), 1e-6);
  EXPECT_NEAR(seconds(1), seconds(0), 1e-6);  // Klipper refuses it

  klipper.cruise_ratio = 0.5;
  EXPECT_NEAR(seconds(0.8), expected(0.8), 1e-6);
  EXPECT_NEAR(seconds(-1), expected(0.5), 1e-6);
  // Ignored since 2024.
  EXPECT_NEAR(SecondsOfMove(klipper, "SET_VELOCITY_LIMIT ACCEL_TO_DECEL=1000"), expected(0.5),
              1e-6);
  // Whoever does not run Klipper cruises as long as there is room for it.
  EXPECT_NEAR(SecondsOfMove({}, "SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0.8"),
              SecondsOfMove({}, "; nothing"), 1e-9);
}

// A line that sets two things holds for the one that no later line set.
TEST(DynamicsOf, WhatALaterLineSetHoldsThoughAnEarlierOneSetMore) {
  SetterTable setters;
  PrintState state{};
  const auto set = [&](const std::string& line, SlotMask slots) {
    ApplySetter(state, setters.Intern(line, slots), slots);
  };
  MachineProfile profile;
  profile.klipper = true;
  for (const char* line : {"SET_VELOCITY_LIMIT ACCEL=1000 MINIMUM_CRUISE_RATIO=0.25 VELOCITY=70",
                           "SET_VELOCITY_LIMIT ACCEL=500", "SET_VELOCITY_LIMIT VELOCITY=90"}) {
    ASSERT_NE(TextSlots(line), 0u) << line;
    set(line, TextSlots(line));
  }

  const Dynamics dynamics = DynamicsOf(profile, state, setters);

  EXPECT_DOUBLE_EQ(dynamics.travel_accel(), 500);
  EXPECT_DOUBLE_EQ(dynamics.print_accel(), 500);
  EXPECT_DOUBLE_EQ(dynamics.max_speed(), 90);
  EXPECT_DOUBLE_EQ(dynamics.cruise_ratio(), 0.25);
}

TEST(MeasureLayers, CountsTravelFromTheFirstToTheLastExtrusion) {
  const auto file = Read(kPrusaSample);

  // The wipe, the travel to the infill, the travel between its lines.
  const double wipe = std::hypot(5, 0.06);
  const PrintTotals totals = Sum(MeasureLayers(*file));
  EXPECT_NEAR(totals.travel_mm, wipe + std::hypot(15, 20) + 1, 1e-6);
  EXPECT_NEAR(totals.extruded_mm, 39.94 + 20, 1e-6);
  EXPECT_EQ(totals.retractions, 1);
  EXPECT_GT(totals.seconds, 0);
}

// The nozzle drips on a short move inwards, too, and on the stretch behind a wall.
TEST(MeasureLayers, AnOpenTravelIsAsLongAsAllItsMoves) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Square(20, 0, 10).Go(20.5, 0.5).Go(20.5, -3).Go(25, -3);
  sketch.Infill(26, -3).Go(26, -5).Infill(28, -5);

  const PrintTotals totals = Sum(MeasureLayers(*sketch.Read()));

  EXPECT_EQ(totals.open_crossings, 1);
  EXPECT_NEAR(totals.longest_open_mm, std::sqrt(0.5) + 3.5 + 4.5, 1e-6);
}

// A short move inwards ends beside a wall that the next one crosses where it begins.
TEST(MeasureLayers, AWayCrossesAWallNearItsBends) {
  Sketch sketch;
  sketch.Square(0, 0, 10).Go(4, 0.5).Infill(5, 0.5).Go(5, 0.2).Go(5, -1).Infill(6, -1);

  const PrintTotals totals = Sum(MeasureLayers(*sketch.Read()));

  EXPECT_EQ(totals.crossings, 1);
  EXPECT_EQ(totals.open_crossings, 1);
}

}  // namespace
}  // namespace traverse::gcode
