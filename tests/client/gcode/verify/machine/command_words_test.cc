#include "client/gcode/verify/machine/command_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace traverse::gcode {
namespace {

TEST(VerifyCommandWords, AreLettersAndNumbersOfAMillionth) {
  const CommandWords words(" X1.5 y-2 E.03 F9000 Z");

  ASSERT_TRUE(words.readable);
  EXPECT_EQ(words['X'], 1'500'000);
  EXPECT_EQ(words['Y'], -2'000'000);
  EXPECT_EQ(words['E'], 30'000);
  EXPECT_EQ(words['Z'], 0);
  EXPECT_EQ(words.ValueOr('F', 7), 9'000'000'000);
  EXPECT_EQ(words.ValueOr('A', 7), 7);
  EXPECT_TRUE(words.OnlyFrom("EFXYZ"));
  EXPECT_FALSE(words.OnlyFrom("FXYZ"));
}

// More digits than a millionth needs, or than fit into nine before the point.
TEST(VerifyCommandWords, LongNumbersAreRounded) {
  const CommandWords words("X1.23456789 Y+2.0000004 Z0000000012.5");

  ASSERT_TRUE(words.readable);
  EXPECT_EQ(words['X'], 1'234'568);
  EXPECT_EQ(words['Y'], 2'000'000);
  EXPECT_EQ(words['Z'], 12'500'000);
  EXPECT_FALSE(CommandWords("X99999999999999999999").readable);
}

// Up to seven digits and six decimals are read at once, others digit by digit.
TEST(VerifyCommandWords, NumbersOfAllLengthsAreReadAlike) {
  const std::string digits = "918273645";
  for (size_t whole = 0; whole <= 9; ++whole) {
    for (size_t decimals = 0; decimals <= 6; ++decimals) {
      const std::string number = digits.substr(0, whole) + "." + digits.substr(0, decimals);
      const double value = whole + decimals > 0 ? std::stod(number) : 0;
      for (const std::string& text :
           {"X" + number, "X-" + number, " X " + number + "Y2", "Z1X" + number + " Y5 "}) {
        const CommandWords words(text);
        ASSERT_EQ(words.readable, whole + decimals > 0) << text;
        if (!words.readable) continue;
        const bool negative = text[1] == '-';
        EXPECT_EQ(words['X'], (negative ? -1 : 1) * std::llround(value * 1e6)) << text;
      }
    }
  }
  EXPECT_FALSE(CommandWords("X123\xb1").readable);
  EXPECT_FALSE(CommandWords("X12345:").readable);
}

TEST(VerifyCommandWords, WhatIsTwiceOrNoWordIsUnreadable) {
  for (const char* text : {"X1 X2", "X1 1", "-X1", "X1 Y-", "X1..5", "X1 \"Y2", "X1 x2"}) {
    const CommandWords words(text);
    EXPECT_FALSE(words.readable) << text;
    EXPECT_FALSE(words.OnlyFrom("XY")) << text;
  }
}

}  // namespace
}  // namespace traverse::gcode
