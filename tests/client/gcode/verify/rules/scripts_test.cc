// Scripts at the start, the end and between layers: client/gcode/verify/rules/scripts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyScripts, NothingOfThemComesBetweenPaths) {
  const std::string start = "M83\nG1 Z5 F3000\nG1 E-2.5 F4800\nG1 E2.5 F4800\n";
  const std::string rest = ";LAYER_CHANGE\nG1 Z.2 F9000\n";
  const std::string two = kZigzag + Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string script =
      With(two, Travel("X0 Y5"), "G1 E-2.5 F4800\nG1 X0 Y5 F9000\nG1 E2.5 F4800\n");
  EXPECT_THAT(Broken(start + rest + two, start + rest + script, {}, ~0u),
              HasSubstr("made_of_parts"));
  const std::string turned = kZigzag + Line("Internal infill", "X9 Y5", "X0 Y5");
  EXPECT_EQ(Broken(start + rest + two, start + rest + turned), "");
}

TEST(VerifyScripts, MoveAsTheyDid) {
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

// G380 goes until something is touched: where the head is then, no file tells.
TEST(VerifyScripts, MoveToWhereTheHeadSeemsToBe) {
  const std::string wipe = "G1 Z2 F1200\nG380 S3 Z-5 F1200\nG1 Z2 F1200\nG1 X94 F10000\n";
  const std::string rest = ";LAYER_CHANGE\nG1 Z.2 F9000\n" + kTwo;
  const std::string a = "M83\nG28\n" + wipe + rest;
  EXPECT_EQ(Broken(a, "M83\nG28\n" + wipe + ";LAYER_CHANGE\nG1 Z.2 F9000\n" + kOneTurned), "");
  const std::string end = "G1 Z2 F1200\nG1 X94";
  for (const char* other : {"G1 X94", "G1 Z2 F600\nG1 X94", "G1 X94 F10000\nG1 Z2 F1200\nG1 X94"}) {
    EXPECT_THAT(Broken(a, With(a, end, other)), HasSubstr("same_print")) << other;
  }
}

// No slicer's own travel leads so far beyond the print.
TEST(VerifyScripts, LeadAsideBetweenLayersAsTheyDid) {
  const auto print = [](const std::string& aside, const std::string& second) {
    return kHead + kTwo + ";LAYER_CHANGE\n" + aside + "G1 Z.4 F9000\n" + second;
  };
  const std::string far = "G1 X5 Y40 F9000\n";
  const std::string near = "G1 X5 Y9 F9000\n";
  const std::string a = print(far, kTwo);

  EXPECT_EQ(Broken(a, print(far, kOneTurned)), "");
  EXPECT_THAT(Broken(a, print("", kOneTurned)), HasSubstr("scripts"));
  EXPECT_THAT(Broken(a, print("G1 X5 Y45 F9000\n", kOneTurned)), HasSubstr("scripts"));
  EXPECT_EQ(Broken(print(near, kTwo), print("", kOneTurned)), "");
}

// Scripts park where start scripts purge: at the edge of the bed.
TEST(VerifyScripts, LeadToThePurgeLineBetweenLayersAsTheyDid) {
  const auto print = [](const std::string& park, const std::string& second) {
    return "M83\nG1 X0 Y-15 Z.2 F9000\nG1 X9 E.5 F900\n;LAYER_CHANGE\nG1 Z.2 F9000\n" + kTwo +
           ";LAYER_CHANGE\n" + park + "G1 Z.4 F9000\n" + second;
  };
  const std::string a = print("G1 X5 Y-15 F9000\n", kTwo);

  EXPECT_EQ(Broken(a, print("G1 X5 Y-15 F9000\n", kOneTurned)), "");
  EXPECT_THAT(Broken(a, print("", kOneTurned)), HasSubstr("scripts"));
}

// Of what lies far from the first path none is on the slicer's way to it.
TEST(VerifyScripts, LeadAsideBeforeThePrintAsTheyDid) {
  const auto print = [](const std::string& aside, const std::string& first) {
    return "M83\nG1 X0 Y-15 Z.2 F9000\nG1 X9 E.5 F900\n;LAYER_CHANGE\n" + aside + "G1 Z.2 F9000\n" +
           first;
  };
  const std::string far = "G1 X40 Y0 F9000\n";
  const std::string near = "G1 X9 Y-9 F9000\n";
  const std::string at_purge = "G1 X5 Y-15 F9000\n";
  const std::string a = print(far, kTwo);

  EXPECT_EQ(Broken(a, print(far, kOneTurned)), "");
  EXPECT_THAT(Broken(a, print("", kOneTurned)), HasSubstr("scripts"));
  EXPECT_THAT(Broken(print(at_purge, kTwo), print("", kOneTurned)), HasSubstr("scripts"));
  EXPECT_THAT(Broken(a, print("G1 X45 Y0 F9000\n", kOneTurned)), HasSubstr("scripts"));
  EXPECT_EQ(Broken(print(near, kTwo), print("", kOneTurned)), "");
}

// The travel back to where lines begin is none, though they all end far from there.
TEST(VerifyScripts, LeadNowhereWherePathsBegin) {
  const auto print = [](const std::string& travel) {
    const std::string line = ";TYPE:Internal infill\nG1 X40 Y0 E1 F1200\n";
    return kHead + "G1 X0 Y0 F9000\n" + line + ";LAYER_CHANGE\nG1 Z.4 F9000\n" + travel + line;
  };
  EXPECT_EQ(Broken(print("G1 X2 Y0 F9000\nG1 X0 Y0\n"), print("G1 X0 Y0 F9000\n")), "");
}

TEST(VerifyScripts, LeaveThePrintAsTheyDid) {
  const std::string end =
      "G1 E-1 F2100\nM107\nG1 E-2 F2400\nG1 Z3 F600\nG1 X5 Y187 F9000\nG1 Z11 F600\n"
      "G1 Z15 F600\nM104 S0\nM84\n";
  const std::string a = kHead + kTwo + end;
  EXPECT_EQ(Broken(a, kHead + kOneTurned + end), "");
  const std::string last_turned =
      Line("Internal infill", "X0 Y0", "X9 Y0") + Line("Internal infill", "X9 Y5", "X0 Y5");
  EXPECT_EQ(Broken(a, kHead + last_turned + end), "");
  const auto with = [&](const std::string& from, const std::string& to) {
    return Broken(a, kHead + last_turned + With(end, from, to));
  };
  EXPECT_THAT(with("G1 Z11 F600\n", ""), HasSubstr("scripts"));
  EXPECT_THAT(with("Z11", "Z12"), HasSubstr("scripts"));
  EXPECT_THAT(with("G1 X5 Y187 F9000\nG1 Z11 F600\n", "G1 Z11 F600\nG1 X5 Y187 F9000\n"),
              HasSubstr("scripts"));
  EXPECT_THAT(with("G1 E-2 F2400\nG1 Z3 F600\n", "G1 Z3 F600\nG1 E-2 F2400\n"),
              HasSubstr("scripts"));
}

// Also where the next path has another height.
TEST(VerifyScripts, TravelsBehindUnknownLinesToALayerGoAsTheyDid) {
  const std::string travel = "G1 X0 Y6 F9000\nG1 E1 F2100\n";
  const std::string a = kHead + kTwo + "G1 E-1 F2100\nG1 Z.4 F9000\nM976 S11\n" + travel +
                        ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y6 E.3\n" +
                        Line("Internal infill", "X9 Y8", "X0 Y8");
  EXPECT_EQ(Broken(a, a), "");
  const std::string early = "G1 E.5 F2100\nG1 X0 Y6 F9000\nG1 E.5 F2100\n";
  EXPECT_THAT(Broken(a, With(a, travel, early), Policy::kFree), HasSubstr("scripts"));
}

// A tower's filament is pushed back where the head stood, not where it goes on.
TEST(VerifyScripts, TravelsToUnknownLinesGoAsTheyDid) {
  const std::string travel = "G1 E-5 F2100\nG1 E2 F2000\nG1 X9 Y7 F2400\n";
  const std::string a = kHead + kTwo + travel + "M976 S11\nG1 E3 F2100\n" +
                        Line("Internal infill", "X0 Y9", "X9 Y9") + kTwo;
  EXPECT_EQ(Broken(a, a), "");
  const std::string later = "G1 E-5 F2100\nG1 X9 Y7 F2400\nG1 E2 F2000\n";
  EXPECT_THAT(Broken(a, With(a, travel, later), Policy::kFree), HasSubstr("scripts"));
}

// A time-lapse stands between two layers or paths: what comes behind it goes as before.
TEST(VerifyScripts, TravelsBehindUnknownLinesGoAsTheyDid) {
  const std::string script = "M976 S11 C10\n";
  const auto line = [](const char* x) {
    return Lifted(absl::StrCat(x, " Y5")) + ";TYPE:Internal infill\nG1 F1800\nG1 " + x +
           " Y9 E.3\n";
  };
  const std::string a = kHead + kLifted + script + line("X0") + line("X1") + line("X2");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, kHead + kLifted + script + line("X1") + line("X0") + line("X2")), "");
  const std::string travel = "G1 X0 Y5 F9000\nG1 Z.2\nG1 E1 F2100\n";
  EXPECT_THAT(Broken(a, With(a, travel, "G1 Z.2\nG1 X0 Y5 F9000\nG1 E1 F2100\n")),
              HasSubstr("scripts"));
  EXPECT_THAT(Broken(a, With(a, travel, "G1 X0 Y5 F9000\nG1 E1 F2100\nG1 Z.2\n")),
              HasSubstr("scripts"));
  EXPECT_EQ(Broken(a, With(a, travel, "G1 X0 Y5 F9000\nG1 X20 Y40\n" + travel)), "bounds");
  EXPECT_EQ(Broken(a, With(a, travel, "G1 X10 Y40 F9000\n" + travel)), "bounds");
  EXPECT_EQ(Broken(a, With(a, travel, "G1 X10 Y22.5 F9000\n" + travel)), "");
  EXPECT_EQ(Broken(a, With(a, travel, "G1 X0 Y5 F9000\nG1 X3 Y5\n" + travel)), "bounds");
}

// They lead where the path before them does, towards the next one or not.
TEST(VerifyScripts, WipesBehindUnknownLinesDoNotWind) {
  const auto print = [](const std::string& near, const std::string& far) {
    const std::string line = ";TYPE:Internal infill\nG1 F1800\nG1 ";
    return kHead + kTwo + Line("Internal infill", "X0 Y7", "X9 Y7") +
           "M976 S11 C10\nG1 E-.2 F2100\n;WIPE_START\nG1 X1 Y7 E-.5 F7200\n;WIPE_END\n" +
           "G1 E-.3 F2100\nG1 " + near + " F9000\nG1 E1 F2100\n" + line + "X5 " + near.substr(3) +
           " E.2\n" + Travel(far) + line + "X5 " + far.substr(3) + " E.2\n";
  };
  const std::string a = print("X0 Y9", "X9 Y11");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, print("X9 Y11", "X0 Y9")), "");
}

// A script leaves its own acceleration behind, and the travel to the next path keeps it.
TEST(VerifyScripts, TravelsBehindUnknownLinesAccelerateAsTheyDid) {
  const std::string script = "M204 S500\nM976 S11 C10\n";
  const auto line = [](const char* x, const char* set = "") {
    return Lifted(absl::StrCat(x, " Y5")) + set + ";TYPE:Internal infill\nG1 F1800\nG1 " + x +
           " Y9 E.3\n";
  };
  const char* set = "M204 S1000\n";
  const std::string a = kHead + set + kLifted + script + line("X0", set) + line("X1") + line("X2");
  EXPECT_EQ(Broken(a, kHead + set + kLifted + script + line("X1", set) + line("X0") + line("X2")),
            "");
  EXPECT_THAT(
      Broken(a, kHead + set + kLifted + script + set + line("X1") + line("X0") + line("X2")),
      HasSubstr("scripts"));
}

}  // namespace
}  // namespace traverse::gcode
