// Lifts of travel: client/gcode/verify/rules/travel/lifts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

// By all rules that tell of heights: how high lifts are, and in which order they are done, parts of
// travel tell.
constexpr uint32_t kWithParts = kRulesOfTheirOwn | RuleBit(VerifyRule::kMadeOfParts);

std::string BrokenByParts(const std::string& original, const std::string& optimised) {
  return Broken(original, optimised, {}, kWithParts);
}

TEST(VerifyLifts, OfTheFirstTravelOfAllTellNothingOfTravelsBetweenLayers) {
  const std::string first = kHead + "G1 E-1 F2100\nG1 Z.6 F9000\nG1 X0 Y0 F9000\nG1 Z.2 F9000\n" +
                            "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X5 Y0 E.3\n" +
                            ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  const std::string inside = Line("Internal infill", "X12 Y12", "X18 Y12");
  const std::string outside = Line("Internal infill", "X0 Y5", "X5 Y5");

  EXPECT_EQ(Broken(first + inside + kSquare + outside, first + outside + inside + kSquare), "");
}

// Nor where a line is primed before the first mark of a layer, higher than the layer is.
TEST(VerifyLifts, OfTheTravelBehindAPurgeLineTellNothingEither) {
  const std::string head = "M83\nG1 Z.3 F9000\nG1 X30 Y12\nG1 X60 Y12 E9 F1000\n" + kHead;
  const std::string inside = LiftedLine("X12 Y15", "X18 Y15");
  const std::string outside = LiftedLine("X30 Y5", "X35 Y5");
  const std::string square = With(kSquare, Travel("X10 Y10"), Lifted("X10 Y10"));
  const std::string last = LiftedLine("X0 Y5", "X5 Y5");
  const std::string next =
      ";LAYER_CHANGE\nG1 E-1 F2100\nG1 Z.8 F9000\nG1 X12 Y15 F9000\nG1 Z.4\n"
      "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X18 Y15 E.3\n";
  const std::string behind = next + With(With(square, "Z.6", "Z.8"), "Z.2", "Z.4");

  EXPECT_EQ(Broken(head + outside + square + inside + last + behind,
                   head + inside + outside + square + last + behind),
            "");
}

TEST(VerifyLifts, AreNeitherDroppedNorHalvedNorDoneTooLate) {
  const std::string travel = Lifted("X10 Y30");
  for (const std::string& other :
       {With(With(travel, "G1 Z.6 F9000\n", ""), "G1 Z.2\n", ""), With(travel, "Z.6", "Z.4"),
        With(With(travel, "G1 Z.6 F9000\n", ""), "F9000\n", "F9000\nG1 Z.6\n"),
        With(With(travel, "G1 Z.6 F9000\n", ""), "Y30", "Y30 Z.6")}) {
    EXPECT_EQ(Broken(kHead + kLifted, kHead + With(kLifted, travel, other)), "lifts") << other;
  }
}

// On a slope short ways rise by a few hundredths of a millimeter.
TEST(VerifyLifts, MayBeLow) {
  const std::string low = With(Lifted("X10 Y40"), "Z.6", "Z.22");
  const std::string last = With(LiftedLine("X10 Y40", "X20 Y40"), Lifted("X10 Y40"), low);
  const std::string one = LiftedLine("X10 Y10", "X20 Y10");
  const std::string other = LiftedLine("X10 Y20", "X20 Y20");
  const std::string more = LiftedLine("X10 Y30", "X20 Y30") + last;
  const std::string a = kHead + one + other + more;
  EXPECT_EQ(Broken(a, kHead + other + one + more), "");
  const std::string dropped = With(one, Lifted("X10 Y10"), Travel("X10 Y10"));
  EXPECT_EQ(Broken(a, kHead + other + dropped + more), "lifts");
}

TEST(VerifyLifts, OfOtherTravelsAreHeightsAboveTheLayer) {
  const std::string other = LiftedLine("X20 Y30", "X10 Y30") + LiftedLine("X10 Y20", "X20 Y20") +
                            LiftedLine("X10 Y10", "X20 Y10") + LiftedLine("X10 Y40", "X20 Y40");
  EXPECT_EQ(Broken(kHead + kLifted, kHead + other), "");
  // A number copied from another layer.
  const std::string copied = With(other, "G1 Z.6 F9000\nG1 X10 Y20", "G1 X10 Y20 Z.9");
  EXPECT_THAT(Broken(kHead + kLifted, kHead + copied), HasSubstr("lifts"));
}

// Lifted above the first layer alone.
TEST(VerifyLifts, OfALayerThatHasThemAreNotDropped) {
  std::string layer = kTwo + Line("Internal infill", "X0 Y10", "X9 Y10") + kNextLayer;
  const auto lifted = [](const char* y, const char* from, const char* to) {
    return absl::StrCat("G1 E-1 F2100\nG1 Z.8 F9000\nG1 X", from, " Y", y,
                        " F9000\nG1 Z.4\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X", to,
                        " Y", y, " E.3\n");
  };
  for (const char* y : {"0", "5", "10", "15", "20", "25"}) layer += lifted(y, "0", "9");
  const std::string last = lifted("25", "0", "9");
  EXPECT_EQ(Broken(kHead + layer, kHead + With(layer, last, lifted("25", "9", "0"))), "");
  EXPECT_EQ(Broken(kHead + layer,
                   kHead + With(layer, last, With(lifted("25", "9", "0"), "G1 Z.8 F9000\n", ""))),
            "lifts");
}

TEST(VerifyLifts, TheHeadRisesBeforeTheTravelToALayer) {
  const std::string unmarked = kTwo + "G1 E-1 F2100\nG1 Z.4 F9000\nG1 X0 Y0 F9000\nG1 E1 F2100\n" +
                               "G1 F1800\nG1 X9 Y0 E.3\n";
  const std::string late =
      With(unmarked, "G1 Z.4 F9000\nG1 X0 Y0 F9000\n", "G1 X0 Y0 F9000\nG1 Z.4 F9000\n");
  EXPECT_EQ(Broken(kHead + unmarked, kHead + late), "lifts");
  EXPECT_EQ(Broken(kHead + late, kHead + late), "");
}

// The short move inwards with which a wall is left, before the head rises and retracts.
TEST(VerifyLifts, TheHeadLeavesAWallBeforeItRisesToALayer) {
  const std::string inwards = "G1 X10.3 Y10.3 F9000\n";
  const std::string wall = kSquare + inwards;
  const std::string line = Line("Internal infill", "X12 Y15", "X18 Y15");
  const std::string to = kNextLayer + Line("Internal infill", "X12 Y12", "X18 Y12");
  EXPECT_EQ(Broken(kHead + wall + line + to, kHead + line + wall + to), "");
  EXPECT_EQ(Broken(kHead + wall + line + to,
                   kHead + line + With(wall, inwards, "G1 X11.3 Y11.3 F9000\n") + to),
            "open_travel lifts path_ends");
  // Or it waits before that.
  const std::string waits = With(to, "G1 E-1 F2100", "M400\nG1 E-1 F2100");
  EXPECT_EQ(Broken(kHead + wall + line + waits, kHead + line + wall + waits), "");
}

// What goes on along the wall without filament is no travel to the layer.
TEST(VerifyLifts, TheTailOfAWallIsAsHighAsTheWall) {
  const std::string wall = kSquare + "G1 X12 Y10\n";
  const std::string line = Line("Internal infill", "X12 Y15", "X18 Y15");
  const std::string to = kNextLayer + Line("Internal infill", "X12 Y12", "X18 Y12");
  EXPECT_EQ(Broken(kHead + wall + line + to, kHead + line + wall + to), "");
  const std::string off = With(wall, "G1 X12 Y10\n", "G1 X12 Y12\n");
  EXPECT_THAT(Broken(kHead + wall + line + to, kHead + line + off + to), HasSubstr("lifts"));
}

// From the top of one object to the foot of the next one.
TEST(VerifyLifts, TheHeadGoesDownBehindTheTravelToAnObject) {
  const std::string first = kTwo + "G1 Z5 F9000\n" + kTwo;
  const std::string travel = "G1 X50 Y50 F9000\nG1 Z.2 F9000\n";
  const std::string a = first + "; printing object b\nG1 E-1 F2100\n" + travel +
                        "G1 E1 F2100\nG1 F1800\nG1 X60 Y50 E.3\n";
  EXPECT_EQ(Broken(kHead + a, kHead + a), "");
  EXPECT_EQ(Broken(kHead + a, kHead + With(a, travel, "G1 Z.2 F9000\nG1 X50 Y50 F9000\n")),
            "same_print");
}

// Object by object: the head comes down beside what is finished, and rises anew from there.
TEST(VerifyLifts, BehindAPrimeOnTheWayTheHeadRisesFromThere) {
  const std::string next =
      ";LAYER_CHANGE\nG1 E-1 F2100\nG1 Z1.4 F9000\nG1 X0 Y60 F9000\nG1 Z.2\n"
      "G1 E1 F2100\n";
  const std::string one = LiftedLine("X40 Y10", "X50 Y10");
  const std::string other = LiftedLine("X40 Y25", "X50 Y25");
  const std::string first = kHead + kLifted + With(kNextLayer, "Z.4", "Z.6") +
                            With(With(LiftedLine("X10 Y40", "X20 Y40"), "Z.6", "Z1"), "Z.2", "Z.6");

  EXPECT_EQ(Broken(first + next + one + other, first + next + other + one), "");
}

TEST(VerifyLifts, NoneIsInventedNorHigher) {
  const std::string higher =
      With(kLifted, Lifted("X10 Y30"), With(Lifted("X10 Y30"), "Z.6", "Z.9"));
  EXPECT_EQ(BrokenByParts(kHead + kLifted, kHead + higher), "made_of_parts");
  const std::string invented =
      With(kTwo, "G1 X0 Y5 F9000\n", "G1 Z.3 F9000\nG1 X0 Y5 F9000\nG1 Z.2\n");
  EXPECT_THAT(BrokenByParts(kHead + kTwo, kHead + invented), HasSubstr("made_of_parts"));
}

// Travel moves that rise all along, by 0.2 mm in 10 mm: how high they come follows from how long
// they are.
TEST(VerifyLifts, OnASlopeOfTheOriginalComeAsHighAsTheirTravelIsLong) {
  const auto line = [](const char* z, const char* from, const char* to) {
    return absl::StrCat("G1 E-1 F2100\nG1 ", from, " Z", z, " F9000\nG1 Z.2 F720\nG1 E1 F2100\n",
                        ";TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  const std::string first = Line("Internal infill", "X0 Y0", "X10 Y0");
  const std::string a = kHead + first + line(".4", "X10 Y10", "X0 Y10") +
                        line(".832", "X10 Y40", "X0 Y40") + line(".4", "X0 Y50", "X10 Y50");
  const auto turned = [&](const char* z, const char* next) {
    return kHead + first + line(z, "X0 Y10", "X10 Y10") + line(next, "X10 Y40", "X0 Y40") +
           line(".4", "X0 Y50", "X10 Y50");
  };
  EXPECT_EQ(Broken(a, turned(".483", ".8")), "");
  EXPECT_EQ(Broken(a, turned(".62", ".8")), "lifts");
  EXPECT_EQ(Broken(a, turned(".483", ".82")), "lifts");
}

// Most of a short one lies lower than the least lift of all, though all of it is as steep as
// others.
TEST(VerifyLifts, OnASlopeOfTheOriginalMayBeShort) {
  const auto line = [](const char* z, const char* from, const char* to) {
    return absl::StrCat("G1 E-1 F2100\nG1 ", from, " Z", z, " F9000\nG1 Z.2 F720\nG1 E1 F2100\n",
                        ";TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  // By 0.2 mm in 10 mm: over 3 and over 30 mm; at last over 26.5 mm.
  const std::string begin = kHead + Line("Internal infill", "X0 Y0", "X10 Y0") +
                            line(".26", "X10 Y3", "X0 Y3") + line(".8", "X0 Y33", "X10 Y33") +
                            line(".8", "X10 Y63", "X0 Y63");
  const std::string a =
      begin + line(".8", "X0 Y93", "X10 Y93") + line(".73", "X10 Y66.5", "X0 Y66.5");
  const auto other = [&](const char* z) {  // over 3.5 mm, and over 26.5 mm
    return begin + line(z, "X0 Y66.5", "X10 Y66.5") + line(".73", "X10 Y93", "X0 Y93");
  };
  EXPECT_EQ(Broken(a, other(".27")), "");
  EXPECT_EQ(Broken(a, other(".265")), "lifts");
}

// Where travel rises over its first 3 mm, shorter travel does so all along.
TEST(VerifyLifts, OnASlopeMayBeShorterThanThat) {
  const auto line = [](const std::string& slope, const char* from, const char* to) {
    return absl::StrCat("G1 E-1 F2100\n", slope, "G1 ", from, " Z.6 F9000\nG1 Z.2 F720\n",
                        "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  const auto from = [](const char* y) { return absl::StrCat("G1 X0 Y", y, " Z.6 F9000\n"); };
  const std::string begin = kHead + Line("Internal infill", "X10 Y0", "X0 Y0") +
                            line(from("3"), "X0 Y20", "X0 Y30") +
                            line(from("33"), "X0 Y50", "X0 Y52.6");
  const std::string a =
      begin + line(from("55.6"), "X0 Y75", "X0 Y65") + line(from("62"), "X0 Y55", "X0 Y57");
  const auto other = [&](const std::string& slope) {
    return begin + line(slope, "X0 Y55", "X0 Y57") + line(from("60"), "X0 Y75", "X0 Y65");
  };
  EXPECT_EQ(Broken(a, other("")), "");
  EXPECT_EQ(Broken(a, other("G1 X0 Y54.8 Z.21 F9000\n")), "lifts");
}

// Nor is it low where other travel across walls rises at once.
TEST(VerifyLifts, OnASlopeOfTheOriginalMayLeadAcrossWalls) {
  const auto line = [](const std::string& rise, const char* from, const char* to) {
    return absl::StrCat("G1 E-1 F2100\n", rise, "G1 ", from, " F9000\nG1 Z.2 F720\n",
                        "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  const std::string begin = kHead + Line("External perimeter", "X20 Y50", "X20 Y-9") +
                            Line("Internal infill", "X0 Y0", "X10 Y0");
  const std::string at_once = "G1 Z.6 F9000\n";
  const std::string a = begin + line("G1 X10 Y3 Z.6 F9000\n", "X10 Y20", "X0 Y20") +
                        line(at_once, "X30 Y20", "X40 Y20") +
                        line("G1 X40 Y23 Z.6 F9000\n", "X40 Y40", "X30 Y40");
  const auto other = [&](const char* slope) {
    return begin + line(absl::StrCat("G1 ", slope, " F9000\n"), "X40 Y40", "X30 Y40") +
           line("G1 X30 Y37 Z.6 F9000\n", "X30 Y20", "X40 Y20") +
           line(at_once, "X10 Y20", "X0 Y20");
  };
  EXPECT_EQ(Broken(a, other("X11.8 Y2.4 Z.6")), "");
  EXPECT_EQ(Broken(a, other("X13.6 Y4.8 Z.6")), "lifts");
}

// Lines of infill with retracted travel moves to them, each lifted but for that to line `low`.
std::string Lines(int count, int low) {
  std::string text = "M83\n;LAYER_CHANGE\nG1 Z.2 F9000\n";
  for (int i = 0; i < count; ++i) {
    const std::string to = absl::StrCat("G1 X", 10 * (i % 2), " Y", i, " F9000\n");
    absl::StrAppend(
        &text, "G1 E-1 F2100\n", i == low ? to : absl::StrCat("G1 Z.6 F9000\n", to, "G1 Z.2\n"),
        "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X", 10 - 10 * (i % 2), " Y", i, " E.3\n");
  }
  return text;
}

int64_t LiftsBroken(const std::string& original, const std::string& optimised) {
  const VerifyReport report = CheckGcode(original, "a", optimised, "b", VerifyOptions());
  return static_cast<int64_t>(report.counts[static_cast<size_t>(VerifyRule::kLifts)]);
}

TEST(VerifyLifts, WhatTheFileLeavesLowMayStayLow) {
  EXPECT_EQ(LiftsBroken(Lines(150, 70), Lines(150, 70)), 0);
  EXPECT_EQ(LiftsBroken(Lines(150, 70), Lines(150, -1)), 0);
  // Another one may not, though the file has one.
  EXPECT_GT(LiftsBroken(Lines(150, 70), Lines(150, 40)), 0);
  EXPECT_GT(LiftsBroken(Lines(150, -1), Lines(150, 40)), 0);
}

TEST(VerifyLifts, AWayThatTheFileLeavesLowMayBeLowInOtherWords) {
  const std::string low = "G1 X0 Y70 F9000\n";
  const std::string in_two = With(Lines(150, 70), low, "G1 X0 Y69.5 F9000\n" + low);
  EXPECT_EQ(LiftsBroken(Lines(150, 70), in_two), 0);
  EXPECT_GT(LiftsBroken(Lines(150, -1), in_two), 0);
  const std::string around = With(in_two, "G1 X0 Y69.5 F9000\n", "G1 X0 Y40 F9000\n");
  EXPECT_GT(LiftsBroken(Lines(150, 70), around), 0);
}

// Not all travel moves of this file are lifted, so that a low one is no break; one that sinks on
// the way is.
TEST(VerifyLifts, NoTravelSinksOnItsTravel) {
  const std::string low = Line("Internal infill", "X10 Y50", "X20 Y50");
  const std::string a = kHead + kLifted + low;
  EXPECT_EQ(Broken(a, a), "");
  const std::string sinks = With(a, "G1 X10 Y40 F9000\nG1 Z.2\n", "G1 X10 Y40 Z.2 F9000\n");
  EXPECT_EQ(Broken(a, sinks), "lifts");
  EXPECT_EQ(Broken(sinks, sinks), "");
  EXPECT_EQ(Broken(sinks, With(sinks, "G1 X10 Y20 F9000\nG1 Z.2\n", "G1 X10 Y20 Z.2 F9000\n")), "");
}

// What an unknown line does is no reason to rise to anywhere beside it.
TEST(VerifyLifts, HeightsBesideUnknownLinesAreThoseOfTheOriginal) {
  const std::string change = "G1 X15 Y15 Z.6 F9000\nTOOL_CHANGE\nG1 X30 Y15 Z.2 F9000\n";
  const std::string a = kHead + kSquare + change +
                        ";TYPE:Internal infill\nG1 F1800\nG1 X31 Y15 E.3\n" +
                        Line("Internal infill", "X30 Y20", "X31 Y20");
  EXPECT_EQ(BrokenByParts(a, a), "");
  EXPECT_THAT(BrokenByParts(a, With(a, "Y15 Z.6", "Y15 Z9 F9000\nG1 X15 Y15 Z.6")),
              HasSubstr("scripts"));
}

TEST(VerifyLifts, TheTravelFromTheStartScriptRisesNoHigherAndDescendsNoDeeper) {
  const std::string purge = "M83\nG1 X20 Y0 Z.2 F9000\nG1 X60 E9 F1000\nG1 X62 F9000\n";
  const std::string travel = ";LAYER_CHANGE\nG1 X10 Y10 Z.6 F9000\nG1 Z.2\n";
  const std::string a = purge + travel + kTwo;
  EXPECT_EQ(Broken(a, purge + travel + kOneTurned), "");
  EXPECT_EQ(Broken(a, With(a, "Z.6", "Z30")), "lifts");
  EXPECT_THAT(Broken(a, With(a, "G1 Z.2\n", "G1 Z.1\nG1 Z.2\n")), HasSubstr("lifts"));
}

TEST(VerifyLifts, TheHeadDoesNotGoDownIntoWhatIsPrinted) {
  const std::string dips =
      With(kTwo, "G1 X0 Y5 F9000\n", "G1 X0 Y5 F9000\nG1 Z.05\nG1 Z.2 F9000\n");
  EXPECT_THAT(BrokenByParts(kHead + kTwo, kHead + dips), HasSubstr("made_of_parts"));
  EXPECT_EQ(BrokenByParts(kHead + dips, kHead + dips), "");
}

TEST(VerifyLifts, AreDoneOnce) {
  const std::string twice =
      With(kLifted, "G1 Z.6 F9000\nG1 X10 Y30", "G1 Z.6 F9000\nG1 Z.2\nG1 Z.6\nG1 X10 Y30");
  EXPECT_EQ(BrokenByParts(kHead + kLifted, kHead + twice), "made_of_parts");
  EXPECT_EQ(BrokenByParts(kHead + twice, kHead + twice), "");
}

// Between layers of which the next one lies lower than the lift, too.
TEST(VerifyLifts, TheHeadDoesNotSinkOnTheTravelUp) {
  const std::string line = "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X0 Y15 E.3\n";
  const auto to_layer = [&](const std::string& z) {
    return "G1 E-1 F2100\nG1 Z.6 F9000\n;LAYER_CHANGE\n" + z + "G1 Z.8 F9000\nG1 X9 Y15\nG1 Z.4\n" +
           line;
  };
  const std::string a = kHead + kLifted + to_layer("");
  EXPECT_EQ(BrokenByParts(a, a), "");
  const std::string dips = kHead + kLifted + to_layer("G1 Z.4 F9000\n");
  EXPECT_EQ(BrokenByParts(a, dips), "made_of_parts");
  EXPECT_EQ(BrokenByParts(dips, dips), "");
}

// On a slope no move rises alone, so that one which does is the first of its kind.
TEST(VerifyLifts, AreNotDoneAgainBehindADescent) {
  const auto line = [](const char* from, const char* to, const char* again) {
    return absl::StrCat("G1 E-1 F2100\nG1 ", from, " Z.6 F9000\nG1 Z.2\n", again, "G1 E1 F2100\n",
                        ";TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  const auto two = [&](const char* again) {
    return kHead + kOne + line("X0 Y20", "X9 Y20", "") + line("X0 Y40", "X9 Y40", again);
  };
  const char* again = "G1 Z.6 F9000\nG1 Z.2\n";
  EXPECT_EQ(BrokenByParts(two(""), two(again)), "made_of_parts");
  EXPECT_EQ(BrokenByParts(two(again), two(again)), "");
}

// A line of infill at `x`, to which a spiral leads around a center beside where it begins.
std::string SpiralLine(const std::string& x, const std::string& spiral) {
  return absl::StrCat("G1 E-1 F2100\nG17\n", spiral, " F9000\nG1 X", x,
                      " Y9 F9000\nG1 Z.2\nG1 E1 F2100\nG1 F1800\nG1 X", x, " Y20 E.3\n");
}

TEST(VerifyLifts, OfASpiralHaveACenterAndADirectionOfTheOriginal) {
  const std::string right = "G3 Z.6 I1.2 J0 P1";
  const std::string up = "G3 Z.6 I0 J1.2 P1";
  const std::string first = kHead + kOne;
  const std::string a = first + SpiralLine("1", right) + SpiralLine("5", up) + SpiralLine("9", up);
  EXPECT_EQ(BrokenByParts(a, a), "");
  // Other travel, with the spirals of the original.
  EXPECT_EQ(
      BrokenByParts(a, first + SpiralLine("9", up) + SpiralLine("1", right) + SpiralLine("5", up)),
      "");
  for (const char* other : {"G2 Z.6 I0 J1.2 P1", "G3 Z.6 I0 J-1.2 P1", "G3 Z.6 I0 J9 P1",
                            "G3 Z.6 I.8 J.9 P1", "G3 Z.6 I0 J1.2 P3"}) {
    const std::string moved =
        first + SpiralLine("9", up) + SpiralLine("1", right) + SpiralLine("5", other);
    EXPECT_EQ(BrokenByParts(a, moved), "made_of_parts") << other;
    EXPECT_EQ(BrokenByParts(a, With(a, up, other)), "made_of_parts") << other;
  }
}

// A lift of 0.4 mm to the next layer is one of 0.2 mm above it, but no lift within a layer is.
TEST(VerifyLifts, WithinALayerAreNotThoseBetweenLayers) {
  const auto line = [](const char* z, const char* back, const char* from, const char* to) {
    return absl::StrCat("G1 E-1 F2100\nG1 Z", z, " F9000\nG1 ", from, " F9000\nG1 Z", back,
                        "\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  const std::string layer = line(".5", ".2", "X10 Y10", "X20 Y10") +
                            line(".5", ".2", "X20 Y20", "X10 Y20") + ";LAYER_CHANGE\n" +
                            line(".6", ".4", "X10 Y40", "X20 Y40");
  const std::string a = kHead + kOne + layer;
  const std::string low = line(".4", ".2", "X20 Y20", "X10 Y20");
  EXPECT_EQ(BrokenByParts(a, a), "");
  // As low as the lift between the layers, in place and between two other points.
  EXPECT_EQ(BrokenByParts(a, With(a, line(".5", ".2", "X20 Y20", "X10 Y20"), low)),
            "lifts made_of_parts");
  const std::string high = line(".6", ".2", "X20 Y20", "X10 Y20");
  EXPECT_EQ(BrokenByParts(a, With(a, line(".5", ".2", "X20 Y20", "X10 Y20"), high)),
            "made_of_parts");
}

// One object after the other: over the first one the head does not go down to the next.
TEST(VerifyLifts, TheHeadSinksWhereItSank) {
  const std::string tower = kHead + kTwo + kNextLayer;
  const std::string low = ";LAYER_CHANGE\nG1 Z.2 F9000\n";
  const std::string end = ";TYPE:Internal infill\nG1 F1800\nG1 X70 Y0 E.3\n";
  const std::string to = "G1 X61 Y0 F9000\nG1 E1 F2100\n";
  const std::string aside = "G1 E-1 F2100\nG1 X60 Y0 F9000\n";
  const std::string a = tower + kTwo + aside + low + to + end;
  EXPECT_EQ(Broken(a, a), "");
  const std::string turned =
      Line("Internal infill", "X0 Y5", "X9 Y5") + Line("Internal infill", "X9 Y0", "X0 Y0");
  EXPECT_EQ(Broken(a, tower + turned + aside + low + to + end), "");
  EXPECT_EQ(Broken(a, tower + kTwo + "G1 E-1 F2100\n" + low + to + end), "obstacles");
  // Down at the path itself.
  EXPECT_EQ(
      Broken(a, tower + kTwo + "G1 E-1 F2100\nG1 X61 Y0 F9000\n" + low + "G1 E1 F2100\n" + end),
      "");
}

// A slope of two stretches comes out as a straight one, which rises a little later.
TEST(VerifyLifts, ASlopeOfTwoStretchesMayBecomeOne) {
  const auto travel = [](const std::string& moves, const std::string& end) {
    return absl::StrCat("G1 E-1 F2100\n", moves, "G1 Z.2\nG1 E1 F2100\n;TYPE:Internal infill\n",
                        "G1 F1800\nG1 ", end, " E.3\n");
  };
  const std::string a = kHead + kOne + travel("G1 X9 Y2.5 Z.244 F9000\n", "X0 Y2.5") +
                        travel("G1 X32 Y2.5 Z.76 F9000\nG1 X36 Y2.5 Z.8\nG1 X60 Y2.5\n", "X60 Y9");
  const auto other = [&](const char* bend) {
    return kHead + kOne + travel(absl::StrCat("G1 ", bend, " Z.8 F9000\nG1 X60 Y2.5\n"), "X60 Y9") +
           travel("G1 X27.404 Y4.846 Z.8 F9000\nG1 X9 Y2.5\n", "X0 Y2.5");
  };
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, other("X45.557 Y1.792")), "");
  EXPECT_EQ(Broken(a, other("X59 Y2.451")), "lifts");
}

// A slope of the same length is a larger share of shorter travel.
TEST(VerifyLifts, ASlopeAsLongAsBeforeMayLeadToANearerPath) {
  const auto travel = [](const std::string& slope, const std::string& from, const std::string& to) {
    return absl::StrCat("G1 E-1 F2100\n", slope, "G1 ", from, "\nG1 Z.2\nG1 E1 F2100\n",
                        ";TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  const std::string a = kHead + kOne + travel("G1 X22 Y0 Z.6 F9000\n", "X60 Y0", "X60 Y9") +
                        travel("G1 X58 Y9 Z.6 F9000\n", "X24 Y9", "X24 Y2") +
                        travel("G1 X26 Y2 Z.6 F9000\n", "X70 Y2", "X70 Y9");
  const auto other = [&](const std::string& slope) {
    return kHead + kOne + travel("G1 X22 Y0 Z.6 F9000\n", "X60 Y0", "X60 Y9") +
           travel(slope, "X70 Y9", "X70 Y2") + travel("G1 X68 Y2 Z.6 F9000\n", "X24 Y2", "X24 Y9");
  };
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, other("G1 X62 Y9 Z.6 F9000\n")), "");
  // A longer one, and what stays low before it.
  EXPECT_EQ(Broken(a, other("G1 X63.5 Y9 Z.6 F9000\n")), "lifts");
  EXPECT_EQ(Broken(a, other("G1 X61.5 Y9 F9000\nG1 X63.5 Y9 Z.6\n")), "lifts");
}

TEST(VerifyLifts, AreNotDoneOnASlopeWhereNoneIs) {
  const std::string up = "G1 Z.6 F9000\nG1 X10 Y30 F9000\n";
  const std::string low = Line("Internal infill", "X10 Y50", "X20 Y50");
  const std::string a = kHead + kLifted + low;
  const std::string slope = With(a, up, "G1 X10 Y30 Z.6 F9000\n");
  EXPECT_EQ(Broken(a, slope), "lifts");
  EXPECT_EQ(Broken(slope, slope), "");
}

// A printer may skip what stands between the labels of an object.
TEST(VerifyLifts, TheHeadRisesOnTheSameSideOfALabel) {
  const std::string travel = Lifted("X10 Y20");
  const std::string label = "; stop printing object a\n";
  const std::string a = kHead + With(kLifted, travel, With(travel, "G1 Z.6", label + "G1 Z.6"));
  const std::string b =
      kHead + With(kLifted, travel, With(travel, "F9000\nG1 X10", "F9000\n" + label + "G1 X10"));
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, b), "lifts");
  EXPECT_EQ(Broken(b, a), "lifts");
}

TEST(VerifyLifts, AreTheSameInRelativeModeAndInAbsolute) {
  const std::string relative =
      With(With(kLifted, "G1 Z.6 F9000\n", "G91\nG1 Z.4 F9000\nG90\nM83\n"), "G1 Z.2\n",
           "G91\nG1 Z-.4\nG90\nM83\n");
  EXPECT_EQ(Broken(kHead + relative, kHead + kLifted), "");
  EXPECT_EQ(Broken(kHead + kLifted, kHead + relative), "");
  EXPECT_NE(Broken(kHead + kLifted, kHead + With(relative, "G1 Z.4", "G1 Z.3")), "");
  // Whatever else is moved so stays where it is.
  const std::string moved = With(kLifted, "G1 Z.6 F9000\n", "G91\nG1 Z.4 X1 F9000\nG90\n");
  EXPECT_NE(Broken(kHead + moved, kHead + kLifted), "");
}

}  // namespace
}  // namespace traverse::gcode
