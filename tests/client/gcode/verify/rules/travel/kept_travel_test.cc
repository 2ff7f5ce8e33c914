// What stands between two paths that still follow each other:
// client/gcode/verify/rules/travel/kept_travel.

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

std::string Kept(const std::string& original, const std::string& optimised) {
  VerifyPermissions permissions;
  permissions.policy = Policy::kFree;
  constexpr uint32_t kRules = RuleBit(VerifyRule::kSamePrint) | RuleBit(VerifyRule::kKeptTravels);
  return Broken(original, optimised, permissions, kRules);
}

const std::string kTo = "G1 X0 Y5 F9000\n";
const std::string kPull = "G1 E-1 F2100\n";

const std::string kPrint = kHead + kTwo;

TEST(VerifyKeptTravels, EachStepIsWhereItWas) {
  const std::string more = kPrint + "G1 X30 Y9 F9000\n" + kWall + "G1 X40 Y9 E.4\n";
  const std::string to = "G1 X30 Y9 F9000\n";
  EXPECT_EQ(Kept(more, more), "");
  // A poke back along the path, a move beyond its end, and one that begins backwards.
  EXPECT_EQ(Kept(more, With(more, to, "G1 X8.6 Y5 F9000\nG1 X9 Y5\n" + to)), "kept_travel");
  EXPECT_EQ(Kept(more, With(more, to, "G1 X9.1 Y5 F1800\n" + to)), "kept_travel");
  EXPECT_EQ(Kept(more, With(more, to, "G1 X8.9 Y4.98 F9000\n" + to)), "kept_travel");
  // A rounded point is no bend.
  EXPECT_EQ(Kept(more, With(more, to, "G1 X19.5 Y7.001 F9000\n" + to)), "");
}

TEST(VerifyKeptTravels, FilamentIsPulledWhereItWas) {
  const std::string late =
      With(kPrint, kOne + kPull + kTo, kOne + "G1 X8.8 Y.11 F9000\n" + kPull + "G1 X0 Y5 F9000\n");
  EXPECT_EQ(Kept(kPrint, late), "kept_travel");
  EXPECT_EQ(Kept(late, late), "");
}

TEST(VerifyKeptTravels, AmountsAndSpeedsStay) {
  const std::string from = kOne + kPull;
  EXPECT_EQ(Kept(kPrint, With(kPrint, from + kTo + "G1 E1 F2100\n",
                              kOne + "G1 E-1 F9000\n" + kTo + "G1 E1 F2100\n")),
            "kept_travel");
  // A hundredth of a percent is what rounding takes.
  EXPECT_EQ(Kept(kPrint, With(kPrint, from + kTo + "G1 E1 F2100\n",
                              kOne + "G1 E-1.0001 F2100\n" + kTo + "G1 E1.0001 F2100\n")),
            "");
}

// Between other paths moves are new, and other rules are there for them.
TEST(VerifyKeptTravels, SayNothingOfNewTravels) {
  const std::string third = Line("Internal infill", "X0 Y20", "X9 Y20");
  const std::string bent = With(third, "G1 X0 Y20 F9000\n", "G1 X8 Y1 F9000\nG1 X0 Y20 F9000\n");
  EXPECT_EQ(Kept(kHead + kTwo + bent, kHead + kOther + kOne + third), "");
  EXPECT_EQ(Kept(kHead + kTwo + bent, kHead + kTwo + third), "kept_travel");
}

TEST(VerifyKeptTravels, TravelsToLayersAreKeptToo) {
  const std::string a = kPrint + kNextLayer + kOther;
  const std::string to = kNextLayer + kPull + kTo;
  EXPECT_EQ(Kept(a, With(a, to, kNextLayer + kPull + "G1 X8.9 Y5.05 F9000\n" + kTo)),
            "kept_travel");
}

// Each travel of the one file could be each of the other's.
TEST(VerifyKeptTravels, OfEqualPathsTakeNoLongerEach) {
  const auto check = [](int lines) {
    std::string slow = kHead;
    std::string fast = kHead;
    for (int i = 0; i < lines; ++i) {
      slow += Line("Internal infill", "X0 Y0", "X9 Y0");
      fast += With(Line("Internal infill", "X0 Y0", "X9 Y0"), "F9000", "F9001");
    }
    EXPECT_EQ(Kept(slow, fast), "kept_travel");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(3000, check), traverse::testing::kSlowGrowth);
}

// There and back: such a path is the same the other way round.
TEST(VerifyKeptTravels, BesidePathsThatLeadBackTravelsMayBeNew) {
  const std::string there = Line("Internal infill", "X0 Y0", "X9 Y0") + "G1 X0 Y0 E.3\n";
  const std::string around = With(kOther, kTo, "G1 X-.5 Y2 F9000\n" + kTo);
  EXPECT_EQ(Kept(kHead + there + around, kHead + there + kOther), "");
}

}  // namespace
}  // namespace traverse::gcode
