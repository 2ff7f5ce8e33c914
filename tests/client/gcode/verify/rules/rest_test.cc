// Islands that are printed again too soon: client/gcode/verify/rules/rest.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_replace.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

constexpr uint32_t kRestRules = RuleBit(VerifyRule::kSamePrint) | RuleBit(VerifyRule::kRest);

// A line of 10 mm at `x`, printed in `seconds`.
std::string Island(double x, int seconds) {
  return absl::StrCat(Travel(absl::StrCat("X", x, " Y0")), ";TYPE:Internal infill\nG1 F",
                      600 / seconds, "\nG1 Y10 E.3\n");
}

// Layers of such islands, each of 4 s, in the order of their positions.
std::string Print(const std::vector<std::vector<double>>& layers, const std::string& between = "") {
  std::string text = "M83\n";
  int height = 1;
  for (const std::vector<double>& layer : layers) {
    text += absl::StrCat(";LAYER_CHANGE\nG1 Z", height++, " F9000\n");
    for (const double x : layer) text += Island(x, 4) + (x == layer.front() ? between : "");
  }
  return text;
}

std::string Rests(const std::string& original, const std::string& optimised,
                  Policy policy = Policy::kSafe) {
  VerifyPermissions permissions;
  permissions.policy = policy;
  return Broken(original, optimised, permissions, kRestRules);
}

TEST(VerifyRest, NoIslandIsPrintedAgainSoonerThanInTheOriginal) {
  const std::string given = Print({{0, 20, 40}, {0, 20, 40}});

  EXPECT_EQ(Rests(given, Print({{0, 20, 40}, {40, 20, 0}})), "rest");
  EXPECT_EQ(Rests(given, Print({{0, 20, 40}, {20, 0, 40}})), "rest");
  EXPECT_EQ(Rests(given, Print({{40, 20, 0}, {40, 20, 0}})), "");
  EXPECT_EQ(Rests(given, Print({{20, 40, 0}, {20, 40, 0}})), "");
}

TEST(VerifyRest, HoldsUnderSafeAndBalanced) {
  const std::string given = Print({{0, 20}, {0, 20}});
  const std::string soon = Print({{0, 20}, {20, 0}});

  EXPECT_EQ(Rests(given, soon), "rest");
  EXPECT_EQ(Rests(given, soon, Policy::kBalanced), "rest");
  EXPECT_EQ(Rests(given, soon, Policy::kFree), "");
}

TEST(VerifyRest, TheStatedLeastLayerTimeIsEnough) {
  const std::string given = Print({{0, 20, 40}, {0, 20, 40}});
  const std::string soon = Print({{0, 20, 40}, {20, 0, 40}});  // 4 s and travel at 40

  EXPECT_EQ(Rests(given + "; slow_down_layer_time = 4\n", soon + "; slow_down_layer_time = 4\n"),
            "");
  EXPECT_EQ(Rests(given + "; slow_down_layer_time = 7\n", soon + "; slow_down_layer_time = 7\n"),
            "rest");
}

TEST(VerifyRest, WhatTheOriginalPrintsAgainAtOnceNeedNotRest) {
  const std::string given = Print({{0, 20}, {20, 0}, {0, 20}});

  EXPECT_EQ(Rests(given, given), "");
  EXPECT_EQ(Rests(given, Print({{20, 0}, {0, 20}, {20, 0}})), "rest");
}

TEST(VerifyRest, DwellsAreRest) {
  const std::string dwell = "G4 P5000\n";
  const std::string given = Print({{0, 20}, {0, 20}}, dwell);

  EXPECT_EQ(Rests(given, Print({{0, 20}, {0, 20}}, dwell)), "");
}

TEST(VerifyRest, LooksBelowLayersThatDoNotReachAnIsland) {
  const std::string given = Print({{0, 20}, {40}, {0, 20}});

  EXPECT_EQ(Rests(given, Print({{0, 20}, {40}, {20, 0}})), "rest");
  EXPECT_EQ(Rests(given, Print({{20, 0}, {40}, {20, 0}})), "");
}

TEST(VerifyRest, CirclesThatDoNotTouchAreIslandsOfTheirOwn) {
  // All but whole circles: their chords are short, and for a line so short its filament is much.
  const auto circle = [](double x) {
    return Travel(absl::StrCat("X", x, " Y0")) +
           absl::StrCat(";TYPE:Internal infill\nG1 F140\nG3 X", x + 0.008, " Y.15 I1.5 J0 E.3\n");
  };
  const std::string a = circle(0);
  const std::string b = circle(5.5);
  const std::string c = circle(40);
  const std::string next = ";LAYER_CHANGE\nG1 Z.4 F9000\n";

  EXPECT_EQ(Rests(kHead + a + b + c + next + a + b + c, kHead + a + c + b + next + a + c + b), "");
  EXPECT_EQ(Rests(kHead + a + b + c + next + a + b + c, kHead + a + c + b + next + b + c + a),
            "rest");
}

// As wide as its filament makes it, a line 0.9 mm beside another one is of its island, and rests
// with that.
TEST(VerifyRest, LinesOfThickFilamentAreWider) {
  const std::vector<double> first = {0, 20, 0.9, 40, 60};
  const auto print = [&first](const std::vector<double>& second) {
    return absl::StrReplaceAll(Print({first, second}), {{"E.3\n", "E2\n"}});
  };
  const std::string thick = "; filament_diameter = 2.85\n";
  const std::string given = print(first);
  const std::string other = print({0.9, 20, 0, 40, 60});

  EXPECT_EQ(Rests(given, other), "rest");
  EXPECT_EQ(Rests(given + thick, other + thick), "");
}

TEST(VerifyRest, IslandsThatCountAsOneRestTogether) {
  const auto islands = [](double apart) {
    // Each rests 12 s, and both together 8 s.
    const std::string given = Print({{0, apart, 20, 40}, {0, apart, 20, 40}});
    return std::pair(Rests(given, Print({{0, 20, 40, apart}, {0, 20, 40, apart}})),
                     Rests(given, Print({{20, apart, 0, 40}, {20, apart, 0, 40}})));
  };

  EXPECT_EQ(islands(2), std::pair(std::string("rest"), std::string()));
  EXPECT_EQ(islands(4), std::pair(std::string(), std::string()));
}

TEST(VerifyRest, IslandsThatHardlyLeaveAirBetweenThemRestAlone) {
  const auto islands = [](double apart) {
    // The second rests 12 s, and 8 s if the next layer begins with it.
    return Rests(Print({{0, apart, 20, 40}, {0, apart, 20, 40}}),
                 Print({{0, apart, 20, 40}, {apart, 0, 20, 40}}));
  };

  EXPECT_EQ(islands(0.7), "rest");
  EXPECT_EQ(islands(0.45), "");  // they touch
}

// All pairs of the loops of a crowd were looked at, and too many made the layer one island.
TEST(VerifyRest, ACrowdOfLoopsInOnePlaceLeavesOtherIslandsApart) {
  const auto layer = [](int z, bool crowd_first) {
    std::string crowd;
    for (int i = 0; i < 2000; ++i) crowd += kSquare;
    const std::string line = Island(60, 4);
    return absl::StrCat(";LAYER_CHANGE\nG1 Z", z, " F9000\n",
                        crowd_first ? crowd + line : line + crowd);
  };
  const std::string given = "M83\n" + layer(1, true) + layer(2, true);
  EXPECT_EQ(Rests(given, "M83\n" + layer(1, true) + layer(2, false)), "rest");
  EXPECT_EQ(Rests(given, given), "");
}

TEST(VerifyRest, PathsOfOneIslandMayComeInAnyOrder) {
  const std::string near = Travel("X0 Y0") + ";TYPE:Internal infill\nG1 F150\nG1 Y10 E.3\n";
  const std::string far = Travel("X0.4 Y0") + ";TYPE:Internal infill\nG1 F150\nG1 Y10 E.3\n";
  const std::string next = ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  const std::string other = Island(40, 4);

  EXPECT_EQ(Rests(kHead + near + far + next + near + far, kHead + near + far + next + far + near),
            "");
  EXPECT_EQ(Rests(kHead + near + far + other + next + near + far + other,
                  kHead + near + far + other + next + far + near + other),
            "");
}

// The next object of a print one by one begins lower than the last one ended, here with a wall that
// rises. Wall and infill are one island, so nothing else is printed before the layer above.
TEST(VerifyRest, AWallThatRisesBehindTheMarkOfALayerIsOfThatOne) {
  const auto layer = [](int height, const std::vector<int>& infill) {
    std::string text =
        absl::StrCat(";LAYER_CHANGE\nG1 Z", height, " F9000\n", "G1 X60 Y0 Z", height - 1,
                     ".1\n;TYPE:Outer wall\nG1 X65 Z", height - 1, ".5 E.1 F1200\nG1 X70 Z", height,
                     " E.2\nG1 Y10 E.3\n", ";TYPE:Internal infill\n");
    for (const int x : infill) {
      absl::StrAppend(&text, "G1 X", x, " Y10 F60\nG1 Y0.4 E.3 F6000\n");
    }
    return text;
  };
  const auto print = [&](const std::vector<int>& infill) {
    return Print({{0}, {0}, {0}}) + layer(1, infill) + layer(2, infill);
  };
  const std::string given = print({62, 68, 64, 66});

  EXPECT_EQ(Rests(given, print({68, 66, 64, 62})), "");
}

}  // namespace
}  // namespace traverse::gcode
