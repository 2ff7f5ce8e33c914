#include "client/gcode/machine/interpreter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace traverse::gcode {
namespace {

std::vector<StepKind> Kinds(const std::string& text) {
  std::vector<StepKind> kinds;
  Interpreter interpreter(text);
  for (Step step; interpreter.Next(step);) kinds.push_back(step.kind);
  return kinds;
}

StepKind LastKind(const std::string& text) { return Kinds(text).back(); }

MachineState After(const std::string& text) {
  Interpreter interpreter(text);
  for (Step step; interpreter.Next(step);) {
  }
  return interpreter.state();
}

TEST(Interpreter, TellsMovesApart) {
  EXPECT_EQ(LastKind("G1 X5 E1"), StepKind::kExtrude);
  EXPECT_EQ(LastKind("G1 X5"), StepKind::kTravel);
  EXPECT_EQ(LastKind("G0 X5 Y2 Z1"), StepKind::kTravel);
  EXPECT_EQ(LastKind("G1 E-1"), StepKind::kFilament);
  EXPECT_EQ(LastKind("M83\nG1 X5 E-.5"), StepKind::kWipe);
  EXPECT_EQ(LastKind("G1 Z.25 F9000"), StepKind::kLift);
  EXPECT_EQ(LastKind("G1 F1200"), StepKind::kFeed);
  EXPECT_EQ(LastKind("G1 X.04 E0"), StepKind::kZeroExtrude);
  EXPECT_EQ(LastKind("G1 X5 E0"), StepKind::kTravel);
  EXPECT_EQ(LastKind("G92 E0"), StepKind::kSetE);
  EXPECT_EQ(LastKind("G92 X0"), StepKind::kModeChange);
}

TEST(Interpreter, AbsoluteExtrusionCountsFromItsRegister) {
  const MachineState state = After("G1 X1 E1\nG1 X2 E1.5\nG92 E0\nG1 X3 E.25");
  EXPECT_EQ(state.e, kDecimalOne / 4);

  Interpreter interpreter("G1 X1 E1\nG1 X2 E1.5\n");
  Step step;
  interpreter.Next(step);
  interpreter.Next(step);
  EXPECT_EQ(step.filament, kDecimalOne / 2);
}

TEST(Interpreter, G91MakesTheExtruderRelativeToo) {
  // CuraEngine's end script: in absolute mode the pull would be to E-2, not by 2.
  Interpreter interpreter("M82\nG92 E100\nG91\nG1 E-2\nG90\nG1 E98.5");
  Step step;
  for (int i = 0; i < 4; ++i) interpreter.Next(step);
  EXPECT_EQ(interpreter.state().e, 98 * kDecimalOne);
  interpreter.Next(step);
  interpreter.Next(step);
  EXPECT_EQ(step.filament, kDecimalOne / 2);
}

TEST(Interpreter, G10RetractsOnlyWithoutWords) {
  // RepRapFirmware sets temperatures with it, in the same files.
  EXPECT_EQ(LastKind("G10"), StepKind::kFirmwareRetract);
  EXPECT_EQ(LastKind("G11 ; unretract"), StepKind::kFirmwareUnretract);
  EXPECT_EQ(LastKind("G10 S215 P0"), StepKind::kUnknown);
  EXPECT_FALSE(After("G10 S215 P0").Retracted());
  EXPECT_TRUE(After("G10").Retracted());
}

TEST(Interpreter, PrimingMoreThanWasPulledBackLeavesNothingRetracted) {
  EXPECT_TRUE(After("M83\nG1 E-.8").Retracted());
  EXPECT_FALSE(After("M83\nG1 E-.8\nG1 E.83").Retracted());
  EXPECT_TRUE(After("M83\nG1 E-.8\nG1 E.83\nG1 E-.02").Retracted());
}

TEST(Interpreter, APrimeOfLessThanWasPulledBackPrimesWhatIsPrintedBehindIt) {
  // After coasting, and with a negative restart distance.
  EXPECT_FALSE(After("M83\nG1 E-6.5\nG1 E6.3\nG1 X1 E.1").Retracted());
  EXPECT_FALSE(After("M83\nG1 E-.5\nG1 E.4\nG92 E0\nG1 F900\nG1 X1 E.1").Retracted());
  EXPECT_FALSE(After("G1 E-.5\nG1 E-.1\nG92 E0\nG1 X1 E.1").Retracted());
  EXPECT_TRUE(After("M83\nG1 E-6.5\nG1 E3\nG1 X1 E.1").Retracted());
  // Filament is unloaded so, and pushed in parts.
  EXPECT_TRUE(After("M83\nG1 E-6.5\nG1 E6.3\nG1 E-4").Retracted());
  Interpreter interpreter("M83\nG1 E-1\nG1 E.7\nG1 E.3\nG1 X1 E.1");
  Step step;
  for (int i = 0; i < 3; ++i) interpreter.Next(step);
  EXPECT_TRUE(interpreter.state().Retracted());
}

TEST(Interpreter, AnotherToolBringsAnotherFilament) {
  EXPECT_TRUE(After("M83\nT0\nG1 E-90\nT0").Retracted());
  EXPECT_FALSE(After("M83\nT0\nG1 E-90\nT1").Retracted());
}

TEST(Interpreter, AWipeAddsUpToARetraction) {
  EXPECT_FALSE(After("M83\nG1 E-.56\nG1 X5 E-.228\nG1 E-.012\nG1 E.8").Retracted());
  EXPECT_TRUE(After("M83\nG1 E-.56\nG1 X5 E-.228\nG1 E-.012").Retracted());
}

TEST(Interpreter, KnowsTheMarksOfEachSlicer) {
  EXPECT_EQ(LastKind(";LAYER_CHANGE"), StepKind::kLayerMark);
  EXPECT_EQ(LastKind(";LAYER:7"), StepKind::kLayerMark);
  EXPECT_EQ(LastKind("; CHANGE_LAYER"), StepKind::kLayerMark);
  EXPECT_EQ(LastKind(";LAYER_COUNT:7"), StepKind::kComment);
  EXPECT_EQ(LastKind(";WIPE_START"), StepKind::kWipeMark);
  EXPECT_EQ(LastKind("; printing object a.stl id:0 copy 6"), StepKind::kLabel);
  EXPECT_EQ(LastKind(";MESH:a.stl"), StepKind::kLabel);
  EXPECT_EQ(LastKind("EXCLUDE_OBJECT_START NAME=a"), StepKind::kLabel);
  EXPECT_EQ(LastKind("M486 S3"), StepKind::kLabel);
  EXPECT_EQ(LastKind(";TYPE:Perimeter"), StepKind::kSlot);
  EXPECT_EQ(LastKind("; LINE_WIDTH: 0.45"), StepKind::kSlot);
  EXPECT_EQ(LastKind("M106 S255"), StepKind::kSlot);
  EXPECT_EQ(LastKind("M204 P800 T1000"), StepKind::kSlot);
  EXPECT_EQ(LastKind("SET_VELOCITY_LIMIT ACCEL=500"), StepKind::kSlot);
  EXPECT_EQ(LastKind("M73 P3 R7"), StepKind::kProgress);
}

TEST(Interpreter, WhatSaysHowFarThePrintIs) {
  for (const char* line :
       {"M117 33%", "M117 Printing 33.5 %", "m117 Layer 12/220", "M118 layer 12 of 220",
        "M117 Time Left 1h2m3s", "M118 A1 P0 action:notification Data Left 12", "M532 X33 L12",
        "SET_DISPLAY_TEXT MSG=\"33 % done\"", "set_display_text MSG=3%", ";TIME_ELAPSED:12.5",
        ";PRINTING_TIME: 41", ";REMAINING_TIME: 60", "; layer num/total_layer_count: 3/20",
        "; progress: 33"}) {
    EXPECT_EQ(LastKind(line), StepKind::kProgress) << line;
  }
  for (const char* line :
       {"M117 Hello", "M117 Object 3", "SET_DISPLAY_TEXT MSG=Hello", "set_display_text MSG=a"}) {
    EXPECT_EQ(LastKind(line), StepKind::kSays) << line;
  }
  EXPECT_EQ(LastKind("M118 Part of the left side"), StepKind::kStay);
  for (const char* line : {"; elapsed", ";TIME:5360", "; 33% infill", "; remaining: none"}) {
    EXPECT_EQ(LastKind(line), StepKind::kComment) << line;
  }
}

TEST(Interpreter, WhatItDoesNotKnowIsUnknown) {
  for (const char* line : {"M600", "G4 P100", "G28", "M400", "PARK_HEAD", "M220 B", "M204 P5 Q7",
                           "SET_VELOCITY_LIMIT ACCEL=500 SOMETHING=1", "G1 X5 A3", "G5 X1 Y1",
                           "M205 X8 S0", "M106 P-9 S255"}) {
    EXPECT_EQ(LastKind(line), StepKind::kUnknown) << line;
  }
}

TEST(Interpreter, ModesMatterOnlyIfTheyChangeSomething) {
  EXPECT_EQ(LastKind("G90"), StepKind::kSays);
  EXPECT_EQ(LastKind("G91"), StepKind::kModeChange);
  EXPECT_EQ(LastKind("G21"), StepKind::kSays);
  EXPECT_EQ(LastKind("G20"), StepKind::kModeChange);
  EXPECT_EQ(LastKind("M83\nM83"), StepKind::kSays);
  EXPECT_EQ(LastKind("T1"), StepKind::kModeChange);
  EXPECT_EQ(LastKind("T1\nT1"), StepKind::kModeChange) << "a macro, or the head parks and primes";
  EXPECT_EQ(LastKind("G91\nG1 X5 E1"), StepKind::kUnknown);
  EXPECT_EQ(LastKind("G1 X5 R2"), StepKind::kUnknown) << "from a stored point, to some machines";
}

TEST(Interpreter, HeatersMatterOnlyIfTheyAreToldSomethingElse) {
  EXPECT_EQ(LastKind("M104 S215"), StepKind::kStay);
  EXPECT_EQ(LastKind("M104 S215\nM104 S215"), StepKind::kSays);
  EXPECT_EQ(LastKind("M109 S215\nM104 S215"), StepKind::kSays);
  EXPECT_EQ(LastKind("M104 S215\nM109 S215"), StepKind::kUnknown) << "waits";
  EXPECT_EQ(LastKind("M104 S215\nM140 S215"), StepKind::kStay) << "the bed";
  EXPECT_EQ(LastKind("M104 S215\nM104 S210\nM104 S215"), StepKind::kStay);
  EXPECT_EQ(LastKind("M104 S215\nM104 S215 T1"), StepKind::kStay);
  EXPECT_EQ(LastKind("M104 S215\nT1\nM104 S215"), StepKind::kStay);
  EXPECT_EQ(LastKind("M104 S215\nPRINT_START\nM104 S215"), StepKind::kStay);
  EXPECT_EQ(LastKind("M104 S215 B9\nM104 S215 B9"), StepKind::kStay);
}

TEST(Interpreter, ArcsNeedACenter) {
  Interpreter interpreter("G2 X5 Y5 E1");
  Step step;
  interpreter.Next(step);
  EXPECT_STREQ(step.fault, "G2 without I, J or R");

  EXPECT_EQ(LastKind("G2 X5 Y5 I2 J3 E1"), StepKind::kExtrude);
  EXPECT_EQ(LastKind("G3 X5 Y5 R9 E1"), StepKind::kExtrude);
  EXPECT_EQ(LastKind("G3 Z.6 I1.2 J0 P1 F9000"), StepKind::kLift);  // a spiral up
  EXPECT_EQ(LastKind("G2 X5 Y5 I2 J3"), StepKind::kTravel);
  EXPECT_EQ(LastKind("G2 X5 Y5 I2 J3 E0"), StepKind::kTravel);
  EXPECT_EQ(LastKind("M83\nG2 X5 Y5 I2 J3 E-.2"), StepKind::kWipe);
}

TEST(Interpreter, HeadAndRegisterStayWhereTheyAreWhenUnitsChange) {
  Interpreter interpreter("M82\nG20\nG1 X2 Y1 Z.1 E.5 F100\nG21\n");
  for (Step step; interpreter.Next(step);) continue;
  const MachineState& state = interpreter.state();
  EXPECT_EQ(state.at.x, 508 * kDecimalOne / 10);
  EXPECT_EQ(state.at.z, 254 * kDecimalOne / 100);
  EXPECT_EQ(state.e, 127 * kDecimalOne / 10);
  EXPECT_EQ(state.feed, 2540 * kDecimalOne);
}

TEST(Interpreter, CoordinatesBeyondReasonAreNotFollowed) {
  EXPECT_EQ(LastKind("G1 X31000 E1"), StepKind::kUnknown);
  EXPECT_EQ(LastKind("M83\nG1 X1 E2000000"), StepKind::kUnknown);
}

TEST(Interpreter, WhatMovesBetweenTheMarksOfAWipeIsAWipe) {
  const std::string wipe = "G1 E-1\n;WIPE_START\nG1 X5\n";
  EXPECT_EQ(LastKind(wipe), StepKind::kWipe);
  EXPECT_EQ(LastKind(wipe + ";WIPE_END\nG1 X9"), StepKind::kTravel);
  // The mark of its end may be missing.
  EXPECT_EQ(LastKind("M83\n" + wipe + "G1 X9 E1\nG1 X12"), StepKind::kTravel);
}

TEST(Interpreter, LiftsMayBeRelative) {
  using K = StepKind;
  const std::string lift = "G1 Z.2\nG91\nG1 Z.4 F720\nG90\n";
  const std::vector<K> kinds = {K::kLift, K::kRelative, K::kLift, K::kRelative};
  EXPECT_EQ(Kinds(lift), kinds);
  EXPECT_EQ(After(lift).at.z, 6 * kDecimalOne / 10);
  EXPECT_EQ(LastKind("M83\n" + lift + "M83"), K::kRelative);
  EXPECT_EQ(LastKind(lift + "M83"), K::kModeChange);
  // All else that moves relatively is left alone.
  for (const char* const other : {"G1 X1 Z.4", "G1 Z.4 E1", "G1 Z.4\nM106 S0", "M400"}) {
    EXPECT_EQ(Kinds(std::string("G91\n") + other + "\nG90").front(), K::kModeChange) << other;
  }
}

TEST(Interpreter, WaitsBelongToTheRetractionsBesideThem) {
  const auto first = [](const std::string& text) { return Kinds(text).front(); };
  EXPECT_EQ(LastKind("G1 E-1\nG4 P50"), StepKind::kDwell);
  EXPECT_EQ(LastKind("G11\n\nG4 P50"), StepKind::kDwell);
  EXPECT_EQ(LastKind("G1 E-1\nM400"), StepKind::kDwell);
  EXPECT_EQ(LastKind("G1 E-1\nM400\nG4 P50"), StepKind::kDwell);
  for (const char* wait : {"G4 P50\n", "M400\n", "M400\n\n; note\nG4 P50\n"}) {
    EXPECT_EQ(first(std::string(wait) + "G1 E-1 F2100"), StepKind::kDwell) << wait;
    EXPECT_EQ(first(std::string(wait) + "G10"), StepKind::kDwell) << wait;
    EXPECT_EQ(first(std::string(wait) + "G1 X5 E-1"), StepKind::kDwell) << wait;
    EXPECT_EQ(first(std::string(wait) + ";WIPE_START\nG1 F7200\nG1 X5 E-1"), StepKind::kDwell)
        << wait;
    EXPECT_EQ(first(std::string(wait) + "G1 F7200\nG1 X5"), StepKind::kUnknown) << wait;
    EXPECT_EQ(first(std::string(wait) + "G1 X5"), StepKind::kUnknown) << wait;
    EXPECT_EQ(first(std::string(wait) + "G1 X5 E1"), StepKind::kUnknown) << wait;
    EXPECT_EQ(first(std::string(wait) + "PAUSE\nG1 E-1"), StepKind::kUnknown) << wait;
  }
  EXPECT_EQ(LastKind("G1 E-1\nG1 X5\nG4 P50"), StepKind::kUnknown);
  EXPECT_EQ(LastKind("G1 E-1\nG1 X5\nM400"), StepKind::kUnknown);
  EXPECT_EQ(LastKind("G1 E-1\nM400 U1"), StepKind::kUnknown);
}

TEST(Interpreter, KnowsNoMoreThanSoManyLinesWithoutADeposit) {
  const auto unknown = [](const std::string& line, int lines) {
    std::string text = "M83\n";
    for (int i = 0; i < lines; ++i) text += line + "\n";
    const std::vector<StepKind> kinds = Kinds(text);
    return std::count(kinds.begin(), kinds.end(), StepKind::kUnknown);
  };

  constexpr int kMost = Interpreter::kMostOfLink;
  for (const char* line : {"", "; remark", "G1 X5", "M117 on"}) {
    EXPECT_EQ(unknown(line, kMost - 2), 0) << line;
    EXPECT_EQ(unknown(line, 3 * kMost), 3) << line;
  }
  EXPECT_EQ(unknown("G1 X1 E1\nG1 X2 E1", kMost), 0);
}

TEST(Interpreter, WaitsFarFromBothPathsBelongToAScript) {
  const auto wait = [](const std::string& before, const std::string& behind) {
    const std::vector<StepKind> kinds = Kinds("M83\nG1 X5 E1\n" + before + "G4 P50\n" + behind);
    return kinds[2 + static_cast<size_t>(std::count(before.begin(), before.end(), '\n'))];
  };
  const std::string park = "G1 X99 F9000\n";

  EXPECT_EQ(wait("G1 E-1\n" + park, "G1 E1\nG1 X5\nG1 X9 E1"), StepKind::kUnknown);
  EXPECT_EQ(wait(park, "G1 X5 E-1"), StepKind::kUnknown);
  EXPECT_EQ(wait(park + "G1 E-1\n", "G1 E1\nG1 X5\nG1 X9 E1"), StepKind::kUnknown);
  // Inwards from the one path, and where the other one begins.
  EXPECT_EQ(wait("G1 X4\nG1 E-1\n", park), StepKind::kDwell);
  EXPECT_EQ(wait(park, "G1 E1\nM204 S500\n;TYPE:Perimeter\nG1 X90 E1"), StepKind::kDwell);
  EXPECT_EQ(wait(park + "G1 E1\n", "G1 X90 E1"), StepKind::kDwell);
  EXPECT_EQ(wait(park + "G1 E1\n", ""), StepKind::kDwell) << "up to a path";
  // Near to where it begins, whatever is said in between.
  EXPECT_EQ(wait(park + "G1 E1\n", "G1 X97\nG1 X90 E1"), StepKind::kDwell);
  EXPECT_EQ(wait(park + "G1 E1\n", "G1 X80\nG1 X99\nG1 X90 E1"), StepKind::kUnknown);
  std::string remarks;
  for (int i = 0; i < 100; ++i) remarks += "; remark\n\n";
  EXPECT_EQ(wait(park + "G1 E1\n", remarks + "G1 X90 E1"), StepKind::kDwell);
  EXPECT_EQ(wait("G1 X4\n", remarks + "G1 E-1\n" + park), StepKind::kDwell);
}

}  // namespace
}  // namespace traverse::gcode
