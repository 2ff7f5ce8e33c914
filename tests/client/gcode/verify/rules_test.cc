// One rule after the other: client/gcode/verify/rules. Of each rule a file that breaks it, and one
// beside it that does not.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyRules, ThePolicyIsThatOfTheFlagsOrOfTheLineAtTheHead) {
  const std::string a = kHead + kSquare;
  const std::string b = kHead + kSquareElsewhere;
  const std::string says = "; optimised by Traverse 1.0, policy balanced: travel\n";

  EXPECT_EQ(FirstMessage(a, says + b), "");
  EXPECT_THAT(FirstMessage(a, b), HasSubstr("seam"));
  EXPECT_EQ(Broken(a, says + b, Policy::kSafe), "seam");
  EXPECT_EQ(Broken(a, b, Policy::kFree), "");
  // Behind a command it is not at the head.
  EXPECT_THAT(FirstMessage(a, With(b, "M83\n", "M83\n" + says)), HasSubstr("seam"));
}

TEST(VerifyRules, WhatIsAllowedIsReadFromTheLineToo) {
  const auto head = PermissionsInHead(
      ";FLAVOR:Marlin\n; optimised by Traverse 1.0, policy safe, allow wall_order+fan_order: x\n");
  ASSERT_TRUE(head.has_value());
  EXPECT_EQ(DescribePermissions(*head), "safe, wall_order, fan_order");
  EXPECT_FALSE(PermissionsInHead("; optimised by Traverse 1.0: x\n").has_value());
  EXPECT_FALSE(ParsePermissions("daring", "").ok());
  EXPECT_FALSE(ParsePermissions("safe", "anything").ok());
}

TEST(VerifyRules, NamesRuleFileAndBothLines) {
  EXPECT_EQ(FirstMessage(kHead + kSquare, kHead + kSquareTurned),
            "b:9: this outer wall is printed the other way round (direction; a:9)");
}

const std::string kZigzag = Way("X10 Y10") +
                            ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y10 E.3\nG1 X20 Y11 E.1\n"
                            "G1 X10 Y11 E.3\n";

TEST(VerifyRules, WholePathsAPathIsNotCut) {
  const std::string cut = Way("X10 Y10") + ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y10 E.3\n" +
                          Way("X10 Y11") + "G1 F1800\nG1 X20 Y11 E.3\nG1 X20 Y10 E.1\n";
  EXPECT_EQ(Broken(kHead + kZigzag, kHead + cut), "whole_paths");
}

TEST(VerifyRules, WholePathsAPathMayBeTurnedAndALoopBegunElsewhere) {
  const std::string turned = Way("X10 Y11") +
                             ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y11 E.3\nG1 X20 Y10 E.1\n"
                             "G1 X10 Y10 E.3\n";
  EXPECT_EQ(Broken(kHead + kZigzag, kHead + turned), "");

  const std::string inner = With(kSquare, "External perimeter", "Perimeter");
  const std::string gap = With(inner, "G1 X10 Y10 E.4", "G1 X10 Y10.06 E.4");
  const std::string elsewhere = Way("X20 Y10") +
                                ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\n"
                                "G1 X10 Y10.06 E.4\nG1 X10 Y10\nG1 X20 Y10 E.4\n";
  EXPECT_EQ(Broken(kHead + gap, kHead + elsewhere), "");
}

TEST(VerifyRules, WholePathsASecondCutOfALoopIsNone) {
  const std::string inner = With(kSquare, "External perimeter", "Perimeter");
  const std::string twice = Way("X20 Y10") + ";TYPE:Perimeter\nG1 F1200\nG1 X20 Y20 E.4\n" +
                            Way("X10 Y20") + "G1 F1200\nG1 X10 Y10 E.4\nG1 X20 Y10 E.4\n" +
                            Way("X20 Y20") + "G1 F1200\nG1 X10 Y20 E.4\n";
  EXPECT_THAT(Broken(kHead + inner, kHead + twice), HasSubstr("whole_paths"));
}

TEST(VerifyRules, OrderInfillStaysBehindTheWallBesideIt) {
  const std::string near = Line("Internal infill", "X12 Y10.4", "X18 Y10.4");
  const std::string far = Line("Internal infill", "X12 Y15", "X18 Y15");

  EXPECT_EQ(Broken(kHead + kSquare + near, kHead + near + kSquare), "order");
  EXPECT_EQ(Broken(kHead + kSquare + near, kHead + near + kSquare, Policy::kFree), "order");
  EXPECT_EQ(Broken(kHead + kSquare + far, kHead + far + kSquare), "");
  VerifyPermissions allowed;
  allowed.infill_order = true;
  EXPECT_EQ(Broken(kHead + kSquare + near, kHead + near + kSquare, allowed), "");
}

TEST(VerifyRules, OrderWallsKeepTheirsUnderSafeAndBalanced) {
  const std::string inner = Line("Perimeter", "X12 Y10.4", "X18 Y10.4");

  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare), "order");
  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare, Policy::kBalanced), "order");
  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare, Policy::kFree), "");
  VerifyPermissions allowed;
  allowed.wall_order = true;
  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare, allowed), "");
}

TEST(VerifyRules, OrderBridgesSupportAndSkirtsKeepTheirs) {
  for (const char* type : {"Bridge infill", "Support material", "Support material interface"}) {
    const std::string one = Line(type, "X0 Y0", "X9 Y0");
    const std::string other = Line("Internal infill", "X0 Y.4", "X9 Y.4");
    EXPECT_EQ(Broken(kHead + one + other, kHead + other + one, Policy::kFree), "order") << type;
    const std::string like = Line(type, "X0 Y.4", "X9 Y.4");
    EXPECT_EQ(Broken(kHead + one + like, kHead + like + one), "") << type;
  }
  const std::string skirt = Line("Skirt/Brim", "X0 Y0", "X9 Y0");
  EXPECT_EQ(Broken(kHead + skirt + kSquare, kHead + kSquare + skirt, Policy::kFree), "order");
}

TEST(VerifyRules, OrderMonotonicSurfacesKeepTheirs) {
  const std::string one = Line("Top solid infill", "X0 Y0", "X9 Y0");
  const std::string two = Line("Top solid infill", "X0 Y.4", "X9 Y.4");
  EXPECT_EQ(Broken(kHead + one + two, kHead + two + one), "order");
  EXPECT_EQ(Broken(kHead + one + two, kHead + two + one, Policy::kFree), "");

  const std::string settings = "; top_fill_pattern = rectilinear\n";
  EXPECT_EQ(Broken(kHead + one + two + settings, kHead + two + one + settings), "");
}

TEST(VerifyRules, OrderThinSkinOverSkinIsIroning) {
  const std::string head = "M83\n;LAYER:1\nG1 Z.2 F9000\n";
  const std::string skin = Line("SKIN", "X0 Y0", "X9 Y0") + Line("SKIN", "X0 Y.4", "X9 Y.4");
  const std::string iron = With(Line("SKIN", "X0 Y.2", "X9 Y.2"), "E.3", "E.02");
  const std::string beside = With(Line("SKIN", "X0 Y2", "X9 Y2"), "E.3", "E.02");

  EXPECT_EQ(Broken(head + skin + iron, head + iron + skin, Policy::kFree), "order");
  EXPECT_EQ(Broken(head + skin + beside, head + beside + skin, Policy::kFree), "");
}

TEST(VerifyRules, DirectionOfOuterLoopsAndOpenWallsIsAsSliced) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareTurned), "direction");
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareTurned, Policy::kBalanced), "direction");
  const std::string open = Line("Perimeter", "X1 Y0", "X9 Y0");
  EXPECT_EQ(Broken(kHead + open, kHead + Line("Perimeter", "X9 Y0", "X1 Y0")), "direction");
}

TEST(VerifyRules, DirectionIsFreeForInfillAndUnderFree) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareTurned, Policy::kFree), "");
  const std::string open = Line("Internal infill", "X1 Y0", "X9 Y0");
  EXPECT_EQ(Broken(kHead + open, kHead + Line("Internal infill", "X9 Y0", "X1 Y0")), "");
}

TEST(VerifyRules, SeamOfAnOuterWallIsTheSamePointOrUnderBalancedASharpCorner) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareElsewhere), "seam");
  const std::string flat = With(kSquare, "G1 X20 Y10 E.4", "G1 X15 Y10 E.2\nG1 X20 Y10 E.2");
  const std::string in_the_middle = Way("X15 Y10") + kWall +
                                    "G1 X20 Y10 E.2\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\n"
                                    "G1 X10 Y10 E.4\nG1 X15 Y10 E.2\n";
  EXPECT_EQ(Broken(kHead + flat, kHead + in_the_middle, Policy::kBalanced), "seam");
}

TEST(VerifyRules, SeamMayMoveToACornerUnderBalancedAndAnywhereOnInnerWalls) {
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareElsewhere, Policy::kBalanced), "");
  const auto inner = [](const std::string& square) {
    return With(square, "External perimeter", "Perimeter");
  };
  EXPECT_EQ(Broken(kHead + inner(kSquare), kHead + inner(kSquareElsewhere)), "");
}

// From within the square to beside it, and on within the square.
const std::string kAcross = kSquare + Line("Internal infill", "X15 Y15", "X16 Y15") +
                            Line("Internal infill", "X30 Y15", "X31 Y15");

TEST(VerifyRules, OpenWaysNoRetractionIsLostAcrossAnOuterWall) {
  const std::string open = With(kAcross, Way("X30 Y15"), "G1 X30 Y15 F9000\n");
  EXPECT_EQ(Broken(kHead + kAcross, kHead + open), "open_ways");
  EXPECT_EQ(Broken(kHead + kAcross, kHead + open, Policy::kFree), "open_ways");
  // Nor comes filament back before the wall.
  const std::string early = With(kAcross, Way("X30 Y15"),
                                 "G1 E-1 F2100\nG1 X18 Y15 F9000\nG1 E1 F2100\nG1 X30 Y15 F9000\n");
  EXPECT_EQ(Broken(kHead + kAcross, kHead + early), "open_ways retractions");
}

TEST(VerifyRules, OpenWaysWithinTheWallAreFree) {
  const std::string within = kSquare + Line("Internal infill", "X15 Y15", "X16 Y15") +
                             Line("Internal infill", "X12 Y18", "X13 Y18");
  EXPECT_EQ(Broken(kHead + within, kHead + With(within, Way("X12 Y18"), "G1 X12 Y18 F9000\n")), "");
}

TEST(VerifyRules, OpenWaysAcrossWallsGetNoLonger) {
  const std::string to_and_fro = With(kAcross, Way("X30 Y15"), "G1 X30 Y15 F9000\n");
  const std::string longer =
      kSquare + Line("Internal infill", "X30 Y15", "X31 Y15") +
      With(Line("Internal infill", "X15 Y15", "X16 Y15"), Way("X15 Y15"), "G1 X15 Y15 F9000\n");
  EXPECT_EQ(Broken(kHead + to_and_fro, kHead + longer), "open_ways");
}

// What goes on along the wall ends on it, so that the way from there begins on it as well.
TEST(VerifyRules, OpenWaysBeginWhereTheMoveAlongTheWallEnds) {
  const std::string wall = kSquare + "G1 X10.4 Y10\n";
  const std::string inside = ";TYPE:Internal infill\nG1 F1800\nG1 X15 Y10.6 E.3\n";
  const std::string a =
      kHead + wall + Line("Internal infill", "X12 Y15", "X18 Y15") + Way("X10.5 Y10.6") + inside;
  const std::string b = kHead + wall + "G1 X10.5 Y10.6 F9000\n" + inside +
                        Line("Internal infill", "X12 Y15", "X18 Y15");

  EXPECT_EQ(Broken(a, b), "");
  // From beyond the wall it leads across it.
  EXPECT_EQ(
      Broken(a, With(b, "G1 X10.5 Y10.6 F9000\n", "G1 X10.5 Y9 F9000\nG1 X10.5 Y10.6 F9000\n")),
      "open_ways");
}

TEST(VerifyRules, LiftsOfTheFirstWayOfAllTellNothingOfWaysBetweenLayers) {
  const std::string first = kHead + "G1 E-1 F2100\nG1 Z.6 F9000\nG1 X0 Y0 F9000\nG1 Z.2 F9000\n" +
                            "G1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X5 Y0 E.3\n" +
                            ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  const std::string inside = Line("Internal infill", "X12 Y12", "X18 Y12");
  const std::string outside = Line("Internal infill", "X0 Y5", "X5 Y5");

  EXPECT_EQ(Broken(first + inside + kSquare + outside, first + outside + inside + kSquare), "");
}

TEST(VerifyRules, LiftsAreNeitherDroppedNorHalvedNorDoneTooLate) {
  const std::string way = Lifted("X10 Y30");
  for (const std::string& other :
       {With(With(way, "G1 Z.6 F9000\n", ""), "G1 Z.2\n", ""), With(way, "Z.6", "Z.4"),
        With(With(way, "G1 Z.6 F9000\n", ""), "F9000\n", "F9000\nG1 Z.6\n"),
        With(With(way, "G1 Z.6 F9000\n", ""), "Y30", "Y30 Z.6")}) {
    EXPECT_EQ(Broken(kHead + kLifted, kHead + With(kLifted, way, other)), "lifts") << other;
  }
}

TEST(VerifyRules, LiftsOfOtherWaysAreHeightsAboveTheLayer) {
  const std::string other = LiftedLine("X20 Y30", "X10 Y30") + LiftedLine("X10 Y20", "X20 Y20") +
                            LiftedLine("X10 Y10", "X20 Y10") + LiftedLine("X10 Y40", "X20 Y40");
  EXPECT_EQ(Broken(kHead + kLifted, kHead + other), "");
  // A number copied from another layer.
  const std::string copied = With(other, "G1 Z.6 F9000\nG1 X10 Y20", "G1 X10 Y20 Z.9");
  EXPECT_THAT(Broken(kHead + kLifted, kHead + copied), HasSubstr("lifts"));
}

TEST(VerifyRules, RetractionsAreNoDeeperAndPairsOfTheOriginal) {
  const std::string two =
      Line("Internal infill", "X0 Y0", "X9 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string deeper =
      With(two, Way("X0 Y5"), "G1 E-1.8 F2100\nG1 X0 Y5 F9000\nG1 E1.8 F2100\n");
  EXPECT_EQ(Broken(kHead + two, kHead + deeper), "retractions");
  const std::string uneven =
      With(two, Way("X0 Y5"), "G1 E-.8 F2100\nG1 X0 Y5 F9000\nG1 E.8 F2100\n");
  EXPECT_EQ(Broken(kHead + two, kHead + uneven), "retractions");
}

TEST(VerifyRules, RetractionsMayBeMoreOrFewer) {
  const std::string two =
      Line("Internal infill", "X0 Y0", "X9 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string fewer = With(two, Way("X0 Y5"), "G1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + two, kHead + fewer), "");
  EXPECT_EQ(Broken(kHead + fewer, kHead + two), "");
}

TEST(VerifyRules, StandstillNoBlobComesInOrMoves) {
  const std::string two =
      Line("Internal infill", "X0 Y0", "X9 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string blob = With(two, Way("X0 Y5"), "G1 E1 F2100\n" + Way("X0 Y5"));
  EXPECT_THAT(Broken(kHead + two, kHead + blob), HasSubstr("standstill"));
  EXPECT_THAT(Broken(kHead + blob, kHead + two), HasSubstr("standstill"));
  const std::string moved = With(two, Way("X0 Y5"), Way("X0 Y5") + "G1 E1 F2100\n");
  EXPECT_THAT(Broken(kHead + blob, kHead + moved), HasSubstr("standstill"));
  EXPECT_EQ(Broken(kHead + blob, kHead + blob), "");
}

TEST(VerifyRules, StandstillWhatIsPushedMoreThanPulledIsPushedAsOften) {
  const std::string more = "G1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E1.02 F2100\n";
  const std::string two = Line("Internal infill", "X0 Y0", "X9 Y0") +
                          With(Line("Internal infill", "X0 Y5", "X9 Y5"), Way("X0 Y5"), more);
  const std::string without = With(two, more, "G1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + two, kHead + without), "standstill");
  // It comes with the way, wherever that leads.
  const std::string turned = With(With(two, "X0 Y5", "X9 Y5"), "G1 X9 Y5 E.3", "G1 X0 Y5 E.3");
  EXPECT_EQ(Broken(kHead + two, kHead + turned), "");
}

TEST(VerifyRules, SpeedsAreThoseOfSuchMoves) {
  const std::string two =
      Line("Internal infill", "X0 Y0", "X9 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string other =
      Line("Internal infill", "X9 Y0", "X0 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + other), "");
  EXPECT_EQ(Broken(kHead + two, kHead + With(other, "X9 Y0 F9000", "X9 Y0 F1800")), "speeds");
  EXPECT_EQ(Broken(kHead + two, kHead + With(other, "G1 E-1 F2100", "G1 E-1 F1800")), "speeds");
}

TEST(VerifyRules, SpeedsTravelKeepsItsAcceleration) {
  const auto path = [](const std::string& from, const std::string& to) {
    return absl::StrCat("M204 P1000\n",
                        With(Line("Internal infill", from, to), "G1 F1800", "M204 P500\nG1 F1800"));
  };
  const std::string two = path("X0 Y0", "X9 Y0") + path("X0 Y5", "X9 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + path("X9 Y0", "X0 Y0") + path("X0 Y5", "X9 Y5")), "");
  EXPECT_EQ(Broken(kHead + two,
                   kHead + With(path("X9 Y0", "X0 Y0"), "P1000", "P900") + path("X0 Y5", "X9 Y5")),
            "speeds");
}

TEST(VerifyRules, WipesLieOnTheirPath) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  const std::string turned = Wiped("X9 Y5", "X0 Y5", "X2 Y5") + Wiped("X9 Y0", "X0 Y0", "X2 Y0");
  EXPECT_EQ(Broken(head + two, head + turned), "");
  const std::string beside = Wiped("X9 Y5", "X0 Y5", "X7 Y5.2") + Wiped("X9 Y0", "X0 Y0", "X2 Y0");
  EXPECT_EQ(Broken(head + two, head + beside), "wipes");
}

TEST(VerifyRules, WipesAreNotLost) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  const std::string bare = With(
      two, "G1 E-.5 F2100\n;WIPE_START\nG1 F7200\nG1 X7 Y0 E-.5\n;WIPE_END\n", "G1 E-1 F2100\n");
  EXPECT_EQ(Broken(head + two, head + bare), "wipes");
  EXPECT_EQ(Broken(head + two, head + two), "");
}

TEST(VerifyRules, CommandsDoNotComeIntoAPath) {
  const std::string flip = With(kZigzag, "G1 X20 Y11", "M204 P900\nM204 P800\nG1 X20 Y11");
  const std::string a = kHead + "M204 P800\n" + kZigzag;
  EXPECT_EQ(Broken(a, kHead + "M204 P800\n" + flip), "commands");
  const std::string has = With(kZigzag, "G1 X20 Y11", "M117 half\nG1 X20 Y11");
  EXPECT_EQ(Broken(kHead + has, kHead + has), "");
}

TEST(VerifyRules, CommandsAreNotInVain) {
  const std::string a = kHead + "M204 P800\n" + kZigzag + kSquare;
  const std::string vain = With(a, kSquare, "M204 P900\nM204 P800\n" + kSquare);
  EXPECT_EQ(Broken(a, vain), "commands");
  // With a move between it is not; here it is the travel's own.
  const std::string travel = With(a, kSquare, "M204 P900\nM204 P800\n" + kSquare);
  EXPECT_EQ(Broken(travel, travel), "");
}

TEST(VerifyRules, ProgressKeepsItsSequence) {
  const std::string a = kHead + "M73 P1\n" + kSquare + "M73 P2\n" + kZigzag;
  EXPECT_EQ(
      Broken(a, With(With(With(a, "M73 P1", "M73 P3"), "M73 P2", "M73 P1"), "M73 P3", "M73 P2")),
      "progress");
  EXPECT_EQ(Broken(a, kHead + "M73 P1\nM73 P2\n" + kSquare + kZigzag), "");
}

TEST(VerifyRules, ScriptsNothingOfThemComesBetweenPaths) {
  const std::string start = "M83\nG1 Z5 F3000\nG1 E-2.5 F4800\nG1 E2.5 F4800\n";
  const std::string rest = ";LAYER_CHANGE\nG1 Z.2 F9000\n";
  const std::string two = kZigzag + Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string script =
      With(two, Way("X0 Y5"), "G1 E-2.5 F4800\nG1 X0 Y5 F9000\nG1 E2.5 F4800\n");
  EXPECT_THAT(Broken(start + rest + two, start + rest + script), HasSubstr("scripts"));
  const std::string turned = kZigzag + Line("Internal infill", "X9 Y5", "X0 Y5");
  EXPECT_EQ(Broken(start + rest + two, start + rest + turned), "");
}

// A line of infill that goes on for 0.04 mm without filament.
std::string Tailed(const std::string& from, const std::string& to, const std::string& on) {
  return absl::StrCat(Line("Internal infill", from, to), "G1 ", on, "\n");
}

TEST(VerifyRules, PathEndsStayWithTheirPaths) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "")), "path_ends");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "G1 X9.2 Y0\n")), "path_ends");
}

TEST(VerifyRules, PathEndsTurnWithTheirPaths) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  const std::string turned =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X9 Y5", "X0 Y5", "X-.04 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + turned), "");
}

// Whichever rule: what a slicer does itself is never refused.
TEST(VerifyRules, AFileIsEquivalentToItself) {
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    for (const std::string& text : {kSquare, kAcross, kLifted, kZigzag}) {
      EXPECT_EQ(Broken(kHead + text, kHead + text, policy), "");
    }
  }
}

TEST(VerifyRules, TellTheLayerOfABreak) {
  const std::string next = ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  const VerifyReport report = CheckGcode(kHead + kZigzag + next + kSquare, "a",
                                         kHead + kZigzag + next + kSquareTurned, "b");
  ASSERT_EQ(report.breaks.size(), 1u);
  EXPECT_EQ(report.breaks[0].layer, 1);
  EXPECT_EQ(report.breaks[0].rule, VerifyRule::kDirection);
}

}  // namespace
}  // namespace traverse::gcode
