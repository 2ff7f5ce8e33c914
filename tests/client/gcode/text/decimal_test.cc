#include "client/gcode/text/decimal.h"

#include <gtest/gtest.h>

namespace traverse::gcode {
namespace {

std::optional<Decimal> Parse(std::string_view text) {
  const char* p = text.data();
  const std::optional<Decimal> value = ParseDecimal(&p, text.data() + text.size());
  return p == text.data() + text.size() ? value : std::nullopt;
}

std::string Format(Decimal value, NumberStyle style = {}) {
  std::string text;
  AppendDecimal(value, style, text);
  return text;
}

TEST(Decimal, ReadsNumbersAsSlicersWriteThem) {
  EXPECT_EQ(Parse("12"), 12 * kDecimalOne);
  EXPECT_EQ(Parse("-.8"), -800'000'000);
  EXPECT_EQ(Parse("9000.000"), 9000 * kDecimalOne);
  EXPECT_EQ(Parse("+1.5"), 1'500'000'000);
  EXPECT_EQ(Parse("0.00001"), 10'000);
  EXPECT_EQ(Parse("5."), 5 * kDecimalOne);
  EXPECT_EQ(Parse("1.1234567890000"), 1'123'456'789);
  EXPECT_EQ(Parse("999999999.999999999"), kDecimalMax - 1);
  EXPECT_EQ(Parse("-1000000000"), -kDecimalMax);
  EXPECT_EQ(Parse("0000000000001.5"), 1'500'000'000);
}

TEST(Decimal, CutsOffMoreThanNineDecimals) {
  EXPECT_EQ(Parse("1.1234567891"), 1'123'456'789);
  EXPECT_EQ(Parse("-68.01900000000001"), -68'019'000'000);
  EXPECT_EQ(Parse("0.99999999999999999999999999"), 999'999'999);
}

TEST(Decimal, RefusesWhatIsNoNumberOrTooLarge) {
  EXPECT_EQ(Parse("1000000001"), std::nullopt);
  EXPECT_EQ(Parse("99999999999999999999999999"), std::nullopt);
  EXPECT_EQ(Parse(""), std::nullopt);
  EXPECT_EQ(Parse("-"), std::nullopt);
  EXPECT_EQ(Parse("."), std::nullopt);
  EXPECT_EQ(Parse("nan"), std::nullopt);
  EXPECT_EQ(Parse("1e5"), std::nullopt);
}

TEST(Decimal, WritesEachStyle) {
  EXPECT_EQ(Format(500'000'000), "0.5");
  EXPECT_EQ(Format(-500'000'000, {-1, false}), "-.5");
  EXPECT_EQ(Format(0, {-1, false}), "0");
  EXPECT_EQ(Format(3 * kDecimalOne), "3");
  EXPECT_EQ(Format(kDecimalOne, {5, true}), "1.00000");
  EXPECT_EQ(Format(0, {3, true}), "0.000");
}

TEST(Decimal, NeverRounds) { EXPECT_EQ(Format(1'234'567, {3, true}), "0.001234567"); }

TEST(Decimal, WritingAndReadingGivesTheSameValue) {
  for (Decimal value = 1; value < kDecimalMax / 7; value = value * 7 + 3) {
    for (const NumberStyle style : {NumberStyle{}, NumberStyle{-1, false}, NumberStyle{5, true}}) {
      EXPECT_EQ(Parse(Format(value, style)), value);
      EXPECT_EQ(Parse(Format(-value, style)), -value);
    }
  }
}

TEST(NumberStyleLearner, TellsPaddedFromTrimmedNumbers) {
  NumberStyleLearner trimmed;
  NumberStyleLearner padded;
  for (const char* token : {"10.5", "3", "121.016", "-.8"}) trimmed.Show(token);
  for (const char* token : {"6", "10.500", "3.000", "121.016"}) padded.Show(token);

  EXPECT_EQ(trimmed.Learned().fixed_decimals, -1);
  EXPECT_FALSE(trimmed.Learned().leading_zero);
  EXPECT_EQ(padded.Learned().fixed_decimals, 3);
  EXPECT_TRUE(padded.Learned().leading_zero);
}

}  // namespace
}  // namespace traverse::gcode
