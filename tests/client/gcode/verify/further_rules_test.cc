// More of the rules of client/gcode/verify/rules: what a stranger would put into a good file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

// Two lines of infill far from each other, and the second one the other way round.
const std::string kTwo =
    Line("Internal infill", "X0 Y0", "X9 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");
const std::string kTwoTurned =
    Line("Internal infill", "X0 Y0", "X9 Y0") + Line("Internal infill", "X9 Y5", "X0 Y5");

const std::string kOneTurned =
    Line("Internal infill", "X9 Y0", "X0 Y0") + Line("Internal infill", "X0 Y5", "X9 Y5");

const std::string kNextLayer = ";LAYER_CHANGE\nG1 Z.4 F9000\n";

TEST(VerifyRules, OrderLinesOfIroningKeepTheirsUnderFreeToo) {
  const std::string one = Line("Ironing", "X0 Y0", "X9 Y0");
  const std::string two = Line("Ironing", "X0 Y.1", "X9 Y.1");
  EXPECT_EQ(Broken(kHead + one + two, kHead + two + one, Policy::kFree), "order");
  const std::string far = Line("Ironing", "X0 Y9", "X9 Y9");
  EXPECT_EQ(Broken(kHead + one + far, kHead + far + one, Policy::kFree), "");
}

TEST(VerifyRules, OrderNothingPassesATower) {
  const std::string tower = Line("Wipe tower", "X50 Y50", "X59 Y50");
  const std::string more = Line("Wipe tower", "X50 Y60", "X59 Y60");
  EXPECT_EQ(Broken(kHead + kTwo + tower, kHead + tower + kTwo, Policy::kFree), "order");
  EXPECT_EQ(Broken(kHead + tower + more, kHead + more + tower, Policy::kFree), "order");
  EXPECT_EQ(Broken(kHead + kTwo + tower + more, kHead + kOneTurned + tower + more), "");
}

TEST(VerifyRules, DirectionOfMonotonicSurfacesIsAsSliced) {
  const auto line = [](const char* type, const char* from, const char* to) {
    return kHead + Line(type, from, to);
  };
  for (const char* type : {"Top solid infill", "Ironing"}) {
    const std::string a = line(type, "X1 Y1", "X9 Y1");
    const std::string b = line(type, "X9 Y1", "X1 Y1");
    EXPECT_EQ(Broken(a, b, Policy::kBalanced), "direction") << type;
    EXPECT_EQ(Broken(a, b, Policy::kFree), "") << type;
  }
  const std::string a = line("Top solid infill", "X1 Y1", "X9 Y1");
  const std::string b = line("Top solid infill", "X9 Y1", "X1 Y1");
  const std::string settings = "; top_fill_pattern = rectilinear\n";
  EXPECT_EQ(Broken(a + settings, b + settings), "");
}

TEST(VerifyRules, SeamMovesNotEvenByAShortSegmentUnderSafe) {
  const std::string fine = With(kSquare, "G1 X20 Y10 E.4", "G1 X10.04 Y10 E.01\nG1 X20 Y10 E.4");
  const std::string moved = Way("X10.04 Y10") + kWall +
                            "G1 X20 Y10 E.4\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\nG1 X10 Y10 E.4\n"
                            "G1 X10.04 Y10 E.01\n";
  EXPECT_EQ(Broken(kHead + fine, kHead + moved), "seam");
  EXPECT_EQ(Broken(kHead + fine, kHead + moved, Policy::kBalanced), "");
}

// Lifted above the first layer alone.
TEST(VerifyRules, LiftsOfALayerThatHasThemAreNotDropped) {
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

TEST(VerifyRules, LiftsTheHeadRisesBeforeTheWayToALayer) {
  const std::string unmarked = kTwo + "G1 E-1 F2100\nG1 Z.4 F9000\nG1 X0 Y0 F9000\nG1 E1 F2100\n" +
                               "G1 F1800\nG1 X9 Y0 E.3\n";
  const std::string late =
      With(unmarked, "G1 Z.4 F9000\nG1 X0 Y0 F9000\n", "G1 X0 Y0 F9000\nG1 Z.4 F9000\n");
  EXPECT_EQ(Broken(kHead + unmarked, kHead + late), "lifts");
  EXPECT_EQ(Broken(kHead + late, kHead + late), "");
}

// From the top of one object to the foot of the next one.
TEST(VerifyRules, LiftsTheHeadGoesDownBehindTheWayToAnObject) {
  const std::string first = kTwo + "G1 Z5 F9000\n" + kTwo;
  const std::string way = "G1 X50 Y50 F9000\nG1 Z.2 F9000\n";
  const std::string a = first + "; printing object b\nG1 E-1 F2100\n" + way +
                        "G1 E1 F2100\nG1 F1800\nG1 X60 Y50 E.3\n";
  EXPECT_EQ(Broken(kHead + a, kHead + a), "");
  EXPECT_EQ(Broken(kHead + a, kHead + With(a, way, "G1 Z.2 F9000\nG1 X50 Y50 F9000\n")),
            "same_print");
}

TEST(VerifyRules, LiftsNoneIsInventedNorHigher) {
  const std::string higher =
      With(kLifted, Lifted("X10 Y30"), With(Lifted("X10 Y30"), "Z.6", "Z.9"));
  EXPECT_EQ(Broken(kHead + kLifted, kHead + higher), "lifts");
  const std::string invented =
      With(kTwo, "G1 X0 Y5 F9000\n", "G1 Z.3 F9000\nG1 X0 Y5 F9000\nG1 Z.2\n");
  EXPECT_THAT(Broken(kHead + kTwo, kHead + invented), HasSubstr("lifts"));
}

// Ways that rise all along, by 0.2 mm in 10 mm: how high they come follows from how long they are.
TEST(VerifyRules, LiftsOnASlopeOfTheOriginalComeAsHighAsTheirWayIsLong) {
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

TEST(VerifyRules, RetractionsAreMadeAtTheHeightOfWhatIsPrinted) {
  const std::string way = Lifted("X10 Y30");
  const std::string above =
      With(With(way, "G1 E1 F2100\n", ""), "G1 Z.2\n", "G1 E1 F2100\nG1 Z.2 F9000\n");
  const std::string late =
      With(With(way, "G1 E-1 F2100\n", ""), "G1 Z.6 F9000\n", "G1 Z.6 F9000\nG1 E-1 F2100\n");
  EXPECT_EQ(Broken(kHead + kLifted, kHead + With(kLifted, way, above)), "retractions");
  EXPECT_EQ(Broken(kHead + kLifted, kHead + With(kLifted, way, late)), "retractions");
  // A slicer may do so.
  std::string all = kLifted;
  for (const char* y : {"X10 Y10", "X10 Y20", "X10 Y30"}) {
    all =
        With(all, Lifted(y),
             With(With(Lifted(y), "G1 E1 F2100\n", ""), "G1 Z.2\n", "G1 E1 F2100\nG1 Z.2 F9000\n"));
  }
  const std::string other = With(all, Lifted("X10 Y40"),
                                 With(With(Lifted("X10 Y40"), "G1 E1 F2100\n", ""), "G1 Z.2\n",
                                      "G1 E1 F2100\nG1 Z.2 F9000\n"));
  EXPECT_EQ(Broken(kHead + all, kHead + other), "");
}

TEST(VerifyRules, RetractionsTheLastOneIsNoDeeper) {
  const std::string end = "G1 E-1 F2100\nM104 S0\nM84\n";
  EXPECT_EQ(Broken(kHead + kTwo + end, kHead + kTwo + With(end, "E-1", "E-1.9")), "retractions");
  EXPECT_EQ(Broken(kHead + kTwo + end, kHead + kOneTurned + end), "");
}

// Each line printed under an acceleration of its own, all ways under one.
std::string Accelerated(const std::string& from, const std::string& to, int print) {
  return absl::StrCat("G1 E-1 F2100\nM204 S1000\nG1 ", from, " F9000\nG1 E1 F2100\nM204 S", print,
                      "\n;TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
}

TEST(VerifyRules, StandstillWhatRoundingLeavesIsNothing) {
  const std::string more = With(kTwo, Way("X0 Y5"), With(Way("X0 Y5"), "E1 ", "E1.0009 "));
  EXPECT_EQ(Broken(kHead + more, kHead + kOneTurned), "");
  const std::string little = With(kTwo, "G1 X9 Y5", "G1 E.00001\nG1 X9 Y5");
  EXPECT_EQ(Broken(kHead + little, kHead + kOneTurned), "");
}

TEST(VerifyRules, SpeedsRetractionsKeepTheirAccelerations) {
  const std::string a = kHead + "M204 S1000\n" + Accelerated("X0 Y0", "X9 Y0", 300) +
                        Accelerated("X0 Y5", "X9 Y5", 400) + Accelerated("X0 Y9", "X9 Y9", 500);
  // Under that of whatever path comes before.
  const std::string other = kHead + "M204 S1000\n" + Accelerated("X0 Y9", "X9 Y9", 500) +
                            Accelerated("X0 Y0", "X9 Y0", 300) + Accelerated("X0 Y5", "X9 Y5", 400);
  EXPECT_EQ(Broken(a, other), "");
  EXPECT_EQ(
      Broken(a, With(other, "E.3\nG1 E-1 F2100\n", "E.3\nM204 S777\nG1 E-1 F2100\nM204 S1000\n")),
      "speeds");
}

TEST(VerifyRules, SpeedsTheAccelerationOfRetractionsIsOneOfThem) {
  const std::string a = kHead + "M204 P500 R900 T1000\n" + kTwo;
  const std::string b =
      kHead + "M204 P500 R900 T1000\n" +
      With(kTwo, Way("X0 Y5"), "M204 P500 R90 T1000\n" + Way("X0 Y5") + "M204 P500 R900 T1000\n");
  EXPECT_EQ(Broken(a, b), "speeds");
}

// A corner that is wiped along both its sides.
std::string WipedCorner(const std::string& wipe) {
  return absl::StrCat("G1 X0 Y5 F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\n",
                      "G1 X5 Y5 E.3\nG1 X5 Y10 E.3\n;WIPE_START\nG1 F7200\n", wipe, ";WIPE_END\n");
}

TEST(VerifyRules, WipesTakeNoShortCut) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string along = WipedCorner("G1 X5 Y5 E-.6\nG1 X1 Y5 E-.4\n");
  const std::string other = WipedCorner("G1 X5 Y5 E-.6\nG1 X2 Y5 E-.4\n");
  const std::string across = WipedCorner("G1 X0 Y5 E-1\n");
  EXPECT_EQ(Broken(head + along, head + along), "");
  EXPECT_EQ(Broken(head + along, head + across), "wipes");
  EXPECT_EQ(Broken(head + across, head + across), "");
  (void)other;
}

TEST(VerifyRules, WipesAreNotShortened) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  EXPECT_EQ(Broken(head + two, head + With(two, "G1 X7 Y5 E-.5", "G1 X8 Y5 E-.5")), "wipes");
  EXPECT_EQ(Broken(head + two, head + With(two, "G1 X7 Y5 E-.5", "G1 X6.5 Y5 E-.5")), "");
}

TEST(VerifyRules, BoundsNoWayLeadsFarAway) {
  const std::string far = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X-90 Y5 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + far), "bounds");
  EXPECT_EQ(Broken(kHead + far, kHead + far), "");
  const std::string near = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X-1 Y5 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + near), "");
}

TEST(VerifyRules, ScriptsMoveAsTheyDid) {
  const std::string start = "M83\nG28\nG1 Z5 F3000\nM109 S200\nG1 Z.3 F3000\nG1 X60 E9 F1000\n" +
                            std::string("G1 X63 Z.05 F8000\nG1 X66 Z.3\n");
  const std::string rest = ";LAYER_CHANGE\nG1 Z.2 F9000\n" + kTwo;
  const std::string end = "M104 S0\nG1 E-2 F2100\nG1 Z10 F9000\nM84\n";
  const std::string a = start + rest + end;
  EXPECT_EQ(Broken(a, start + ";LAYER_CHANGE\nG1 Z.2 F9000\n" + kOneTurned + end), "");
  for (const char* line : {"G1 Z5 F3000\n", "G1 X63 Z.05 F8000\n", "G1 E-2 F2100\n"}) {
    EXPECT_THAT(Broken(a, With(a, line, "")), HasSubstr("same_print")) << line;
  }
}

}  // namespace
}  // namespace traverse::gcode
