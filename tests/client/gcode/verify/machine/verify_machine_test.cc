#include "client/gcode/verify/machine/verify_machine.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace traverse::gcode {
namespace {

bool IsRetractedAfter(const std::string& text) {
  VerifyMachine machine(text);
  VerifyLine line;
  while (machine.Next(line)) {
  }
  return machine.retracted();
}

TEST(VerifyMachine, WhatMostlyComesBackRightBeforeADepositIsBack) {
  const std::string deposit = "G1 X1 E.01\n";
  EXPECT_TRUE(IsRetractedAfter("M83\nG1 E-1 F2100\n"));
  EXPECT_FALSE(IsRetractedAfter("M83\nG1 E-1 F2100\nG1 E1\n"));
  EXPECT_FALSE(IsRetractedAfter("M83\nG1 E-1 F2100\nG1 E.8\n" + deposit));
  EXPECT_TRUE(IsRetractedAfter("M83\nG1 E-1 F2100\nG1 E.8\n"));
  EXPECT_TRUE(IsRetractedAfter("M83\nG1 E-1 F2100\nG1 E.4\n" + deposit));
  // In two pulls, the deepest of which counts.
  EXPECT_FALSE(IsRetractedAfter("M83\nG1 E-.5 F2100\nG1 E-.5\nG1 E.8\n" + deposit));
}

TEST(VerifyMachine, APushInPartsIsShortOfNothing) {
  VerifyMachine machine("M83\nG1 E-1 F2100\nG1 E.7\nG1 E.3\nG1 X1 E.01\n");
  for (VerifyLine line; machine.Next(line);) EXPECT_EQ(line.surplus, 0);
}

TEST(VerifyMachine, G92SaysWhereTheAxesAreThatItNames) {
  VerifyMachine machine("G90\nG1 X10 Y20 Z1 F9000\nG92 X1 Z2\nG91\nG1 X.5 Y.5 Z.5\n");
  VerifyLine line;
  while (machine.Next(line)) {
  }
  EXPECT_EQ(machine.at()[0], 1'500'000);
  EXPECT_EQ(machine.at()[1], 20'500'000);
  EXPECT_EQ(machine.z(), 2'500'000);
}

LineRole LastRole(const std::string& text) {
  VerifyMachine machine(text);
  VerifyLine line;
  while (machine.Next(line)) {
  }
  return line.role;
}

TEST(VerifyMachine, WhatWaitsFarFromBothPathsIsAFence) {
  const auto wait = [](const std::string& before, const std::string& behind) {
    const std::string text = "M83\nG1 X5 E1 F900\n" + before + "G4 P50\n" + behind;
    VerifyMachine machine(text);
    for (VerifyLine line; machine.Next(line);) {
      if (line.text == "G4 P50") return line.role;
    }
    return LineRole::kProgress;
  };
  const std::string park = "G1 X99 F9000\n";

  EXPECT_EQ(wait("G1 E-1\n" + park, "G1 E1\nG1 X5\nG1 X9 E1\n"), LineRole::kFixed);
  EXPECT_EQ(wait(park, "G1 X5 E-1\n"), LineRole::kFixed);
  EXPECT_EQ(wait(park + "G1 E-1\n", "G1 E1\nG1 X5\nG1 X9 E1\n"), LineRole::kFixed);
  EXPECT_NE(wait("G1 X4\nG1 E-1\n", park), LineRole::kFixed);
  EXPECT_NE(wait(park, "G1 E1\nM204 S500\n;TYPE:Perimeter\nG1 X90 E1\n"), LineRole::kFixed);
  EXPECT_NE(wait(park + "G1 E1\n", "G1 X90 E1\n"), LineRole::kFixed);
  // Near to where it begins, whatever is said in between.
  EXPECT_NE(wait(park + "G1 E1\n", "G1 X97\nG1 X90 E1\n"), LineRole::kFixed);
  EXPECT_EQ(wait(park + "G1 E1\n", "G1 X80\nG1 X99\nG1 X90 E1\n"), LineRole::kFixed);
  std::string remarks;
  for (int i = 0; i < 100; ++i) remarks += "; remark\n\n";
  EXPECT_NE(wait(park + "G1 E1\n", remarks + "G1 X90 E1\n"), LineRole::kFixed);
  EXPECT_NE(wait("G1 X4\n", remarks + "G1 E-1\n" + park), LineRole::kFixed);
}

// How E counts is guessed where nothing says so, and the guess depends on the order of the lines.
TEST(VerifyMachine, SmallLettersSayHowFilamentCountsToo) {
  VerifyMachine machine(
      "g21\n m83\ng1 x1 y0 e1\ng1 x2 y0 e.5\ng0 x0 y9 f9000\ng1 x1 y9 e.6\ng1 x2 y9 e.7\n");
  std::vector<LineRole> roles;
  for (VerifyLine line; machine.Next(line);) roles.push_back(line.role);
  EXPECT_EQ(roles[1], LineRole::kFixed) << "it counted in the other way before";
}

// RepRapFirmware goes to a stored point then, and there on by what the other words say.
TEST(VerifyMachine, WordsOfArcsOnAStraightMoveAreNotKnown) {
  for (const char* word : {"R2", "I1", "J1", "P0"}) {
    EXPECT_EQ(LastRole(std::string("M83\nG1 X1 Y0 F9000 ") + word + "\n"), LineRole::kFixed);
    EXPECT_EQ(LastRole(std::string("M83\nG1 X1 Y0 E1 ") + word + "\n"), LineRole::kFixed);
  }
  EXPECT_EQ(LastRole("M83\nG2 X1 Y0 I.5 J0 P0 E1\n"), LineRole::kDeposit);
}

TEST(VerifyMachine, G92OfTheFilamentAloneIsNoFence) {
  EXPECT_EQ(LastRole("M82\nG92 E0\n"), LineRole::kNothing);
  EXPECT_EQ(LastRole("M82\nG92 X0 E0\n"), LineRole::kFixed);
  EXPECT_EQ(LastRole("M82\nG92\n"), LineRole::kFixed);
}

// With words it is the standby temperature of a tool, or offsets.
// As Klipper takes them.
TEST(VerifyMachine, MacrosMayBeInAnyCase) {
  for (const char* macro : {"TIMELAPSE_TAKE_FRAME\n", "timelapse_take_frame\n",
                            "Exclude_Object_Start NAME=a\n", "set_print_stats_info TOTAL=3\n"}) {
    EXPECT_EQ(LastRole(macro), LineRole::kFence) << macro;
  }
  EXPECT_EQ(LastRole("set_display_text MSG=Hello\n"), LineRole::kComment);
  EXPECT_EQ(LastRole("set_display_text MSG=33%\n"), LineRole::kProgress);
  EXPECT_EQ(LastRole("timelapse_take_frames\n"), LineRole::kFixed);
}

TEST(VerifyMachine, G10RetractsWhereItHasNoWords) {
  EXPECT_TRUE(IsRetractedAfter("M83\nG10\n"));
  EXPECT_FALSE(IsRetractedAfter("M83\nG10\nG11\n"));
  EXPECT_EQ(LastRole("M83\nG10\n"), LineRole::kNothing);
  EXPECT_EQ(LastRole("M83\nG10 P1 S200\n"), LineRole::kFixed);
}

TEST(VerifyMachine, ACommentThatNumbersALayerIsAFence) {
  EXPECT_EQ(LastRole("; layer 5, Z = 1.0\n"), LineRole::kFence);
  EXPECT_EQ(LastRole("; layer height 0.2\n"), LineRole::kComment);
  EXPECT_EQ(LastRole("; width 0.4\n"), LineRole::kComment);
}

// A scan for the next line feed in each of these lines would take minutes.
TEST(VerifyMachine, CarriageReturnsAloneTakeNoLonger) {
  std::string text;
  for (int i = 0; i < 1'000'000; ++i) text += "G1 X1 Y1\r";
  VerifyMachine machine(text);
  size_t lines = 0;
  for (VerifyLine line; machine.Next(line);) ++lines;
  EXPECT_EQ(lines, 1'000'000u);
}

}  // namespace
}  // namespace traverse::gcode
