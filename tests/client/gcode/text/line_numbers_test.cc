// Numbered lines: client/gcode/text/line_numbers.h.

#include "client/gcode/text/line_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace traverse::gcode {
namespace {

std::string There(const std::string& text) {
  const auto numbers = LearnLineNumbers(text);
  return numbers ? WithoutLineNumbers(text, *numbers) : "none";
}

std::string ThereAndBack(const std::string& text) {
  const auto numbers = LearnLineNumbers(text);
  return numbers ? WithLineNumbers(WithoutLineNumbers(text, *numbers), *numbers) : "none";
}

TEST(LineNumbers, AFileWithoutHasNone) {
  EXPECT_EQ(There(""), "none");
  EXPECT_EQ(There("G28\n;N5\nM117 N5\n\nNOTE\nN\n"), "none");
}

TEST(LineNumbers, TheChecksumIsTheExclusiveOrOfTheBytesBeforeIt) {
  EXPECT_EQ(There("N3 T0*57\nN4 G92 E0*67\nN5 G28*22\n"), "T0\nG92 E0\nG28\n");
  EXPECT_EQ(ThereAndBack("N3 T0*57\nN4 G92 E0*67\nN5 G28*22\n"),
            "N3 T0*57\nN4 G92 E0*67\nN5 G28*22\n");
  EXPECT_EQ(There("N3 T0 *25\nN5 G28 *54\n"), "T0\nG28\n");
}

TEST(LineNumbers, CommentsBlankLinesAndLineEndsStay) {
  const std::string text = "; a\r\n\r\nN0 T0*58\r\r\n ;N7\nN1 G28*18";

  EXPECT_EQ(There(text), "; a\r\n\r\nT0\r\r\n ;N7\nG28");
  EXPECT_EQ(ThereAndBack(text), text);
}

TEST(LineNumbers, AreKeptInTheirForm) {
  for (const char* text :
       {"N10 G28\nN20 G1 X1 ; in\nN30 M117 2*3\n", "N7G28\nN8G1 X1\n", "N5  G28\nN4  G28\n",
        "M110 N0\nN1 G28\nN2 G28\n", "N1 G28*18 ; home\nN2 G28*17\n", "N1 G28*18\t;*5\n",
        "N1 G28 ; home*38\nN2 G28*17\n", "N1 G28\n", "N1 G28 *50\nN2 G28 *49 ; home\n"}) {
    EXPECT_EQ(ThereAndBack(text), text);
  }
}

TEST(LineNumbers, WhatIsOutOfOrderIsFound) {
  const auto odd = [](const std::string& text) {
    return FirstOtherLine(text, ThereAndBack(text)).value_or(999);
  };

  EXPECT_EQ(odd("N1 G28*18\nN2 G28*17\n"), 999u);
  EXPECT_EQ(odd("N1 G28*18\nN2 G28*18\n"), 10u);
  EXPECT_EQ(odd("N1 G28\nN2 G28\nN4 G28\n"), 14u);
  EXPECT_EQ(odd("N1 G28\nN2 G28\nG28\n"), 14u);
  EXPECT_EQ(odd("N1 G28*18\nN2 G28"), 10u);
  EXPECT_EQ(odd("N01 G28\n"), 0u);
  EXPECT_EQ(odd("N1 G28\nN9999999999999999999999 G28\n"), 7u);
}

}  // namespace
}  // namespace traverse::gcode
