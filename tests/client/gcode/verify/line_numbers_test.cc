// Numbered lines, as the verifier sees them: client/gcode/verify/line_numbers.h.

#include "client/gcode/verify/line_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/client/gcode/support/verified.h"

namespace traverse::gcode {
namespace {

using ::testing::HasSubstr;

std::string Text(std::string_view text) {
  const auto unnumbered = WithoutNumbers(text);
  return unnumbered ? unnumbered->text : "none";
}

std::string Break(const std::string& original, const std::string& optimised) {
  return std::string(VerifyGcode(original, "a", optimised, "b").message());
}

TEST(WithoutNumbers, LeavesTheLines) {
  EXPECT_EQ(Text("; a\nN3 T0*57\r\nN4 G92 E0*67 ; b\n"), "; a\n T0\r\n G92 E0 ; b\n");
  EXPECT_EQ(Text("G28\nN10 G28\nN20 M117 2*3"), "G28\n G28\n M117 2*3");
}

TEST(WithoutNumbers, NothingOfWhatAMachineWouldNotTake) {
  for (const char* text :
       {"", "G28\n", "N3 T0*58\n", "N3 T0*57\nN4 G28\n", "N1 G28\nN2 G28\nN4 G28\n",
        "N1 G28\nG28\n", "N1 G28*18\nN1 G28*18\nN2 G28*17\n", "N-1 G28\n", "N G28\n"}) {
    EXPECT_EQ(Text(text), "none") << text;
  }
}

TEST(VerifyLineNumbers, ALineThatIsNotNumberedOnIsABreak) {
  const std::string original =
      "N1 M83*25\nN2 G1 Z.2 F900*19\nN3 G1 X5 Y5*42\nN4 G1 X9 Y5 E1*117\nN5 M107*32\n";

  EXPECT_EQ(Break(original, original), "");
  // Another number with its own checksum; a checksum that is wrong; numbers that begin elsewhere.
  for (const auto& [from, to] :
       {std::pair("N5 M107*32", "N6 M107*35"), std::pair("N5 M107*32", "N5 M107*1"),
        std::pair("N5 M107*32", "M107")}) {
    std::string other = original;
    other.replace(other.find(from), std::string(from).size(), to);
    EXPECT_NE(Break(original, other), "") << to;
  }
  EXPECT_NE(Break("N1 M83\nN2 G1 X5 E1\n", "N2 M83\nN3 G1 X5 E1\n"), "");
}

TEST(VerifyLineNumbers, WhatTheLinesPrintIsComparedAsWithoutNumbers) {
  EXPECT_THAT(Break("N1 M83\nN2 G1 X5 E1\n", "N1 M83\nN2 G1 X5 E2\n"), HasSubstr("b:2"));
}

}  // namespace
}  // namespace traverse::gcode
