// Travel, time and filament of layers: client/gcode/measure/layer_meter.h.

#include "client/gcode/measure/layer_meter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/samples.h"
#include "tests/client/gcode/support/scattered_lines.h"

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
}

TEST(MeasureLayers, CountsTravelFromTheFirstToTheLastExtrusion) {
  const auto file = Read(kPrusaSample);

  // The wipe, the way to the infill, the way between its lines.
  const double wipe = std::hypot(5, 0.06);
  const PrintTotals totals = Sum(MeasureLayers(*file));
  EXPECT_NEAR(totals.travel_mm, wipe + std::hypot(15, 20) + 1, 1e-6);
  EXPECT_NEAR(totals.extruded_mm, 39.94 + 20, 1e-6);
  EXPECT_EQ(totals.retractions, 1);
  EXPECT_GT(totals.seconds, 0);
}

}  // namespace
}  // namespace traverse::gcode
