// What stands in the way of the head: client/gcode/verify/rules/obstacles.

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

std::string Layer(double z) { return absl::StrFormat(";LAYER_CHANGE\nG1 Z%.2f F9000\n", z); }

std::string Square(double low, double high) {
  return absl::StrCat(Travel(absl::StrCat("X", low, " Y", low)), kWall, "G1 X", high, " E.4\nG1 Y",
                      high, " E.4\nG1 X", low, " E.4\nG1 Y", low, " E.4\n");
}

// A finished tower of 6 mm between X20 and X26, and beside it a line on either side, far from it,
// with `between` on the way from one to the other, at Z.2.
std::string PastATower(const std::string& between, double near_mm = 5) {
  std::string print = "M83\n";
  for (int layer = 1; layer <= 30; ++layer) {
    absl::StrAppend(&print, Layer(0.2 * layer), Square(20, 26));
  }
  const double left = 20 - near_mm;
  const double right = 26 + near_mm;
  absl::StrAppend(&print, "G1 E-1 F2100\nG1 Z7 F9000\nG1 X", left, " Y20 F9000\n", Layer(.2));
  absl::StrAppend(&print, "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 Y26 E.3\n");
  absl::StrAppend(&print, "G1 E-1 F2100\n", between, "G1 X", right, " Y26 F9000\n");
  absl::StrAppend(&print, "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 Y20 E.3\n");
  return print;
}

std::string Obstacles(const std::string& original, const std::string& optimised) {
  return Broken(original, optimised, {}, RuleBit(VerifyRule::kObstacles));
}

const std::string kRound = "G1 X15 Y40 F9000\nG1 X31 Y40 F9000\n";
const std::string kAbove = "G1 Z6.2 F9000\nG1 X31 Y26 F9000\nG1 Z.2 F9000\n";

TEST(VerifyObstacles, NoTravelLeadsThroughWhatIsFinished) {
  EXPECT_EQ(Obstacles(PastATower(kRound), PastATower("")), "obstacles");
  EXPECT_EQ(Obstacles(PastATower(kAbove), PastATower("")), "obstacles");
  EXPECT_EQ(Obstacles(PastATower(kRound), PastATower("G1 Z3 F9000\nG1 X31 Y26 F9000\nG1 Z.2\n")),
            "obstacles");
}

// Start scripts wipe the nozzle on a slope through the line that they have purged.
TEST(VerifyObstacles, WhatTheOriginalDoesItselfNeedsNoProof) {
  const std::string print =
      "M83\nG0 X68 Y-2.5 F9000\nG0 Z.3\nG0 X88 E10 F192\nG0 X113 E2 F320\nG0 X115 Z0 F20000\n"
      "G0 Z5\nG1 X20 Y20\n" +
      absl::StrCat(kWall, "G1 X26 E.4\nG1 Y26 E.4\n");
  EXPECT_EQ(Obstacles(print, print), "");
}

TEST(VerifyObstacles, TravelLeadsAboveOrWhereThatOfTheOriginalDoes) {
  EXPECT_EQ(Obstacles(PastATower(kRound), PastATower(kRound)), "");
  EXPECT_EQ(Obstacles(PastATower(kRound), PastATower(kAbove)), "");
  EXPECT_EQ(Obstacles(PastATower(""), PastATower("")), "");
  EXPECT_EQ(Obstacles(PastATower(""), PastATower("G1 X23 Y26 F9000\nG1 X29 Y26 F9000\n")), "");
  // As low as the original's and no lower.
  const std::string at_five = "G1 Z5 F9000\nG1 X31 Y26 F9000\nG1 Z.2 F9000\n";
  const std::string at_four = "G1 Z4 F9000\nG1 X31 Y26 F9000\nG1 Z.2 F9000\n";
  EXPECT_EQ(Obstacles(PastATower(at_four), PastATower(at_five)), "");
  EXPECT_EQ(Obstacles(PastATower(at_five), PastATower(at_four)), "obstacles");
}

TEST(VerifyObstacles, ASlopeIsAboveWhatStandsBeforeItIsThere) {
  const std::string late = "G1 X23 Y26 Z6.2 F9000\nG1 X31 Y26 F9000\nG1 Z.2 F9000\n";
  const std::string soon = "G1 X16 Y26 Z6.2 F9000\nG1 X31 Y26 F9000\nG1 Z.2 F9000\n";
  EXPECT_EQ(Obstacles(PastATower(kRound), PastATower(late)), "obstacles");
  EXPECT_EQ(Obstacles(PastATower(kRound), PastATower(soon)), "");
}

TEST(VerifyObstacles, TheHeadGoesDownOnlyBesideWhatStands) {
  const std::string into =
      "G1 Z6.2 F9000\nG1 X26 Y26 F9000\nG1 Z.2 F9000\nG1 Z6.2 F9000\n"
      "G1 X31 Y26 F9000\nG1 Z.2 F9000\n";
  EXPECT_EQ(Obstacles(PastATower(kAbove), PastATower(into)), "obstacles");
}

TEST(VerifyObstacles, OtherPartsOfTheHeadNeedTheRoomThatTheFileStates) {
  // 2.5 mm past a side of the tower that the original's head never was near to.
  const std::string by = "G1 X15 Y28.5 F9000\nG1 X31 Y28.5 F9000\n";
  const std::string narrow = "; extruder_clearance_radius = 1\n; nozzle_height = 4\n";
  const std::string wide = "; extruder_clearance_radius = 12\n; nozzle_height = 4\n";
  const std::string round = PastATower("G1 X0 Y60 F9000\nG1 X50 Y60 F9000\n", 14);
  const std::string near = PastATower(by, 14);
  EXPECT_EQ(Obstacles(round, near), "obstacles");
  EXPECT_EQ(Obstacles(narrow + round, narrow + near), "");
  EXPECT_EQ(Obstacles(wide + round, wide + near), "obstacles");
  // The nozzle itself is longer than the tower is high.
  const std::string slim = "; extruder_clearance_radius = 12\n; nozzle_height = 8\n";
  EXPECT_EQ(Obstacles(slim + round, slim + near), "obstacles");
  const std::string lifted = "G1 Z5 F9000\n" + by + "G1 X40 Y26 F9000\nG1 Z.2 F9000\n";
  EXPECT_EQ(Obstacles(slim + round, slim + PastATower(lifted, 14)), "");
}

TEST(VerifyObstacles, AnotherTravelPastWhatTheOriginalComesAsNearToIsFine) {
  // On the other side of a line that the head prints beside the tower.
  EXPECT_EQ(Obstacles(PastATower("G1 X15 Y27 F9000\nG1 X31 Y27 F9000\n"),
                      PastATower("G1 X14 Y28 F9000\nG1 X31 Y28 F9000\n")),
            "");
}

TEST(VerifyObstacles, TheMoveBehindTheLastPathIsATravelToo) {
  const std::string to_the_right = PastATower(kRound) + "G1 Z1 F9000\nG1 X40 Y20\n";
  const std::string through = PastATower(kRound) + "G1 Z1 F9000\nG1 X18 Y20\n";
  EXPECT_EQ(Obstacles(to_the_right, to_the_right), "");
  EXPECT_EQ(Obstacles(to_the_right, through), "obstacles");
}

TEST(VerifyObstacles, SaysHowFarBelowTheTop) {
  VerifyOptions options;
  options.rules = RuleBit(VerifyRule::kObstacles);
  const VerifyReport report = CheckGcode(PastATower(kRound), "a", PastATower(""), "b", options);
  ASSERT_EQ(report.breaks.size(), 1u);
  EXPECT_NE(report.breaks[0].message.find("leads 5.80 mm below the top of what stands at X2"),
            std::string::npos)
      << report.breaks[0].message;
}

}  // namespace
}  // namespace traverse::gcode
