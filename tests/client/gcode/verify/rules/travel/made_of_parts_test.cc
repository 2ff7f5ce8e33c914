// In which order travel takes its steps: client/gcode/verify/rules/travel/made_of_parts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

constexpr uint32_t kRules = RuleBit(VerifyRule::kSamePrint) | RuleBit(VerifyRule::kMadeOfParts);

std::string Ordered(const std::string& original, const std::string& optimised) {
  return Broken(original, optimised, {}, kRules);
}

std::string MessageOf(const std::string& original, const std::string& optimised) {
  VerifyOptions options;
  options.rules = kRules;
  return CheckGcode(original, "a", optimised, "b", options).breaks.front().message;
}

// A lift of 0.01 mm is none to the rules of lifts, but it has a place among the steps.
std::string Low(const std::string& to, const std::string& y) {
  return "G1 E-1 F2100\nG1 Z.21 F9000\nG1 " + to + " F9000\nG1 Z.2\nG1 E1 F2100\n" +
         ";TYPE:Internal infill\nG1 F1800\nG1 X9 " + y + " E.3\n";
}

const std::string kLow = Low("X0 Y0", "Y0") + Low("X0 Y5", "Y5") + Low("X0 Y9", "Y9");

TEST(VerifyMadeOfParts, ThatOfTheOriginal) {
  const std::string a = kHead + kLow;
  const std::string pull = "G1 E-1 F2100\n";
  const std::string rise = "G1 Z.21 F9000\n";
  const std::string end = "G1 Z.2\nG1 E1 F2100\n";
  const std::string last = "G1 X0 Y9 F9000\n";
  EXPECT_EQ(Ordered(a, a), "");
  EXPECT_EQ(Ordered(a, With(a, pull + rise + last, rise + pull + last)), "made_of_parts");
  EXPECT_EQ(Ordered(a, With(a, last + end, last + "G1 E1 F2100\nG1 Z.2 F9000\n")), "made_of_parts");
  EXPECT_THAT(
      MessageOf(a, With(a, pull + rise + last, rise + pull + last)),
      HasSubstr(
          "leaves by move up, retraction of 1.0000 mm; no such travel of the original does so"));
  // Either order, if the original has both.
  const std::string both = With(a, pull + rise + last, rise + pull + last);
  const std::string turned = kHead + Low("X0 Y0", "Y0") +
                             With(Low("X0 Y5", "Y5"), pull + rise, rise + pull) +
                             With(Low("X0 Y9", "Y9"), pull + rise, rise + pull);
  EXPECT_EQ(Ordered(both, turned), "");
}

// Which steps lead to a layer depends on where its first path is, but none comes too early.
TEST(VerifyMadeOfParts, NothingComesEarlyToALayer) {
  const std::string to = "G1 E-1 F2100\n;LAYER_CHANGE\nG1 Z.4 F9000\nG1 X0 Y5\nG1 E1 F2100\n";
  const std::string first = ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y5 E.3\n";
  const std::string a = kHead + kTwo + to + first;
  EXPECT_EQ(Ordered(a, a), "");
  const std::string rises = ";LAYER_CHANGE\nG1 Z.4 F9000\nG1 E-1 F2100\nG1 X0 Y5 F9000\n";
  EXPECT_EQ(Ordered(a, kHead + kTwo + rises + "G1 E1 F2100\n" + first), "made_of_parts");
}

// Between paths that meet, one above the other, there is no travel to cut the link at: it still
// leaves and arrives as others do.
TEST(VerifyMadeOfParts, NoTravelToALayerHasPartsToo) {
  const std::string line = ";TYPE:Internal infill\nG1 F1800\n";
  const std::string below = kHead + kTwo + "G1 E-1 F2100\nG1 X0 Y7 F9000\nG1 E1 F2100\n" + line +
                            "G1 X9 Y7 E.3\n;LAYER_CHANGE\nG1 Z.4 F9000\n";
  const std::string leaves = "G1 E-1 F2100\nG1 Z.6 F9000\n";
  const std::string arrives = "G1 Z.4\nG1 E1 F2100\n";
  const std::string a = below + leaves + "G1 X0 Y7\n" + arrives + line + "G1 X9 Y7 E.3\n";
  const std::string met = line + "G1 X0 Y7 E.3\n";
  EXPECT_EQ(Ordered(a, below + leaves + arrives + met), "");
  EXPECT_EQ(Ordered(a, below + "G1 E-1 F2100\nG1 E1 F2100\n" + met), "");
  EXPECT_EQ(Ordered(a, below + leaves + "G1 E1 F2100\nG1 Z.4 F9000\n" + met), "made_of_parts");
}

// Where the head stays, it need not rise and come down again.
TEST(VerifyMadeOfParts, NoLiftWhereNothingTravels) {
  const std::string line = ";TYPE:Internal infill\nG1 F1800\n";
  const std::string below = kHead + kLifted + kNextLayer;
  const std::string a = below + "G1 E-1 F2100\nG1 Z.8 F9000\nG1 X10 Y40\nG1 Z.4\nG1 E1 F2100\n" +
                        line + "G1 X20 Y40 E.3\n";
  const std::string met = line + "G1 X10 Y40 E.3\n";
  EXPECT_EQ(Ordered(a, below + "G1 E-1 F2100\nG1 E1 F2100\n" + met), "");
  EXPECT_EQ(Ordered(a, below + "G1 E-1 F2100\nG1 E1 F900\n" + met), "made_of_parts");
  EXPECT_EQ(Ordered(a, below + "G1 E-1 F2100\nG1 Z.8 F9000\nG1 E1 F2100\nG1 Z.4 F9000\n" + met),
            "made_of_parts");
}

// Nor is there any where the next path begins where the wipe ends.
TEST(VerifyMadeOfParts, PathsThatAWipeLinksAreLeftAndReachedAsOthers) {
  const auto line = [](const std::string& from, const std::string& to) {
    return from + "G1 Z.2\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 " + to + " E.3\n";
  };
  const std::string pull = "G1 E-.5 F2100\n;WIPE_START\nG1 F7200\nG1 X7 Y0 E-.5\n;WIPE_END\n";
  const std::string up = "G1 Z.6 F9000\n";
  const std::string head = kHead + "G1 E-1 F2100\n" + up + line("G1 X0 Y0 F9000\n", "X9 Y0") + pull;
  const std::string end = "G1 E-1 F2100\n" + up + line("G1 X0 Y9 F9000\n", "X9 Y9");
  const std::string a = head + up + line("G1 X7 Y5\n", "X7 Y0") + end;
  EXPECT_EQ(Ordered(a, head + up + line("", "X7 Y5") + end), "");
  EXPECT_EQ(Ordered(a, head + "G1 Z.5 F9000\n" + line("", "X7 Y5") + end), "made_of_parts");
}

TEST(VerifyMadeOfParts, FilamentMovesAtTheHeightOfWhatIsPrinted) {
  const std::string travel = Lifted("X10 Y30");
  const std::string above =
      With(With(travel, "G1 E1 F2100\n", ""), "G1 Z.2\n", "G1 E1 F2100\nG1 Z.2 F9000\n");
  const std::string late =
      With(With(travel, "G1 E-1 F2100\n", ""), "G1 Z.6 F9000\n", "G1 Z.6 F9000\nG1 E-1 F2100\n");
  EXPECT_EQ(Ordered(kHead + kLifted, kHead + With(kLifted, travel, above)), "made_of_parts");
  EXPECT_EQ(Ordered(kHead + kLifted, kHead + With(kLifted, travel, late)), "made_of_parts");
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
  EXPECT_EQ(Ordered(kHead + all, kHead + other), "");
}

TEST(VerifyMadeOfParts, PrimesNotBelowTheLayer) {
  const std::string rise = "G1 Z.4 F9000\n";
  const std::string prime = "G1 E1 F2100\n";
  const std::string line = ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y0 E.3\n";
  const std::string travel = kHead + kTwo + "G1 E-1 F2100\n;LAYER_CHANGE\nG1 X0 Y0 F9000\n";
  EXPECT_EQ(Ordered(travel + rise + prime + line, travel + rise + prime + line), "");
  EXPECT_EQ(Ordered(travel + rise + prime + line, travel + prime + rise + line), "made_of_parts");
  EXPECT_EQ(Ordered(travel + prime + rise + line, travel + prime + rise + line), "");
}

// A link of many steps, in which what is pulled back before each prime counts.
TEST(VerifyMadeOfParts, ManyStepsOfALinkTakeNoLongerEach) {
  const auto check = [](int steps) {
    std::string travel = "G1 E-1 F2100\n";
    for (int step = 0; step < steps; ++step) {
      absl::StrAppend(&travel, "G1 Z.", 6 + step % 2, " F9000\nG1 E-.1 F2100\nG1 E.1 F2100\n");
    }
    travel += "G1 X0 Y9 F9000\nG1 Z.2\nG1 E1 F2100\n";
    const std::string line = ";TYPE:Internal infill\nG1 F1800\n";
    const std::string a = kHead + kTwo + travel + line + "G1 X9 Y9 E.3\n";
    EXPECT_NE(Ordered(a, kHead + kTwo + With(travel, "X0", "X9") + line + "G1 X0 Y9 E.3\n"), "x");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(2'500, check), traverse::testing::kSlowGrowth);
}

TEST(VerifyMadeOfParts, WhatWaitsStillDoes) {
  const auto line = [](const std::string& from, const std::string& to, const std::string& waits) {
    return "G1 E-1 F2100\n" + waits + "G1 " + from + " F9000\nG1 E1 F2100\n" +
           ";TYPE:Internal infill\nG1 F1800\nG1 " + to + " E.3\n";
  };
  const std::string wait = "G4 P50\n";
  const auto two = [&](bool turned, const std::string& waits) {
    return kHead + line("X0 Y9", "X9 Y9", wait) +
           (turned ? line("X9 Y0", "X0 Y0", waits) : line("X0 Y0", "X9 Y0", waits)) +
           line("X0 Y5", "X9 Y5", waits);
  };
  EXPECT_EQ(Broken(two(false, wait), two(true, wait), {}, ~0u), "");
  EXPECT_EQ(Ordered(two(false, wait), two(true, "")), "made_of_parts");
  EXPECT_NE(Broken(two(false, wait), two(true, "G4 P500\n"), {}, ~0u), "");
  // Elsewhere waiting has reasons of its own.
  const std::string apart = "G1 F1800\nG4 P50\n";
  EXPECT_NE(Broken(two(false, apart), two(false, ""), {}, ~0u), "");
}

}  // namespace
}  // namespace traverse::gcode
