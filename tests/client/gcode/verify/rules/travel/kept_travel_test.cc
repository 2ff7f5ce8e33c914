// What stands between two paths that still follow each other:
// client/gcode/verify/rules/travel/kept_travel.

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
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

TEST(VerifyKeptTravels, WaitAsLongAsTheyDid) {
  const std::string waits = With(kPrint, kTo + "G1 E1 F2100\n", kTo + "G4 P200\nG1 E1 F2100\n");
  EXPECT_EQ(Kept(waits, waits), "");
  EXPECT_EQ(Kept(waits, With(waits, "G4 P200", "G4 P5000")), "kept_travel");
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

// Nobody can say which of two lines in one place the next path follows.
TEST(VerifyKeptTravels, SayNothingOfALineThatIsPrintedTwice) {
  const std::string bent = With(kOther, kTo, "G1 X8 Y3 F9000\n" + kTo);
  const std::string a = kHead + kOne + bent;
  EXPECT_EQ(Kept(a + kOne, kHead + kOne + kOne + kOther), "");
  EXPECT_EQ(Kept(a + kOne, kHead + kOne + kOther + kOne), "");
  EXPECT_EQ(Kept(a, kHead + kOne + kOther), "kept_travel");
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

// Nothing lies between the paths, and another travel of the layer is open and as long.
TEST(VerifyKeptTravels, ARetractionStaysWithItsTravel) {
  const std::string third = Line("Internal infill", "X0 Y10", "X9 Y10");
  const std::string open = "G1 X0 Y10 F9000\n";
  const std::string a = kTwo + With(third, Travel("X0 Y10"), open);
  const std::string moved =
      With(With(a, Travel("X0 Y5"), "G1 X0 Y5 F9000\n"), open, Travel("X0 Y10"));
  EXPECT_EQ(Kept(kHead + a, kHead + moved), "kept_travel");
  // A travel move from there to another point may be open.
  const std::string turned =
      With(With(a, Travel("X0 Y5"), "G1 X9 Y5 F9000\n"), "G1 X9 Y5 E.3", "G1 X0 Y5 E.3");
  EXPECT_EQ(Kept(kHead + a, kHead + turned), "");
}

// One travel in three is lifted: nothing is to be learnt of travel moves as such.
std::string ThreeTravels(const std::string& lifted) {
  return absl::StrCat(kHead, kTwo, Lifted("X0 Y10"),
                      ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y10 E.3\n", lifted,
                      ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y20 E.3\n",
                      Line("Internal infill", "X0 Y30", "X9 Y30"));
}

TEST(VerifyKeptTravels, ALiftStaysWithItsTravel) {
  const std::string travel = Lifted("X0 Y20");
  const std::string a = ThreeTravels(travel);
  EXPECT_EQ(Kept(a, a), "");
  EXPECT_EQ(Kept(a, ThreeTravels(Travel("X0 Y20"))), "kept_travel");
  const std::string half = With(travel, "Z.6", "Z.4");
  EXPECT_EQ(Kept(a, ThreeTravels(half)), "kept_travel");
  // A travel move from there to another point may be low.
  const std::string turned = With(ThreeTravels(Travel("X9 Y20")), "G1 X9 Y20 E.3", "G1 X0 Y20 E.3");
  EXPECT_EQ(Kept(a, turned), "");
}

// The layer has both speeds: which way goes at which does not change.
TEST(VerifyKeptTravels, SpeedsStayWithTheirTravels) {
  const auto line = [](const char* y, const char* speeds) {
    return absl::StrCat("G1 X0 Y", y, speeds, "G1 X9 Y", y, " E.3\n");
  };
  const std::string slow = " F6000\n;TYPE:Internal infill\nG1 F1800\n";
  const std::string fast = " F9000\n;TYPE:Internal infill\nG1 F1800\n";
  const auto print = [&](const std::string& a, const std::string& b, const std::string& c) {
    return kHead + line("0", fast.c_str()) + line("3", a.c_str()) + line("6", b.c_str()) +
           line("9", c.c_str());
  };
  EXPECT_EQ(Kept(print(slow, fast, slow), print(slow, fast, slow)), "");
  EXPECT_EQ(Kept(print(slow, fast, slow), print(slow, slow, slow)), "kept_travel");
  // Another travel may go at either speed.
  const std::string a = print(slow, fast, slow);
  EXPECT_EQ(Kept(a, kHead + line("0", fast.c_str()) + line("6", slow.c_str()) +
                        line("3", fast.c_str()) + line("9", fast.c_str())),
            "");
  const std::string quick = With(a, "G1 X0 Y6", "M204 T500\nG1 X0 Y6");
  EXPECT_EQ(Kept(quick, With(quick, "M204 T500\n", "")), "kept_travel");
}

// Of the travel moves that are not retracted too few are lifted to tell anything of others.
TEST(VerifyKeptTravels, LiftsOfOpenTravelsStayWithThem) {
  const std::string lifted = "G1 Z.6 F9000\nG1 X0 Y6 F9000\nG1 Z.2\n";
  const auto line = [](const std::string& travel, const char* y) {
    return absl::StrCat(travel, ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y", y, " E.3\n");
  };
  const std::string a = kHead + line("G1 X0 Y0 F9000\n", "0") + line("G1 X0 Y3 F9000\n", "3") +
                        line(lifted, "6") + line("G1 X0 Y9 F9000\n", "9");
  EXPECT_EQ(Kept(a, a), "");
  EXPECT_EQ(Kept(a, With(a, lifted, "G1 X0 Y6 F9000\n")), "kept_travel");
}

// A full circle leads back to where it began, and passes the same points either way round.
TEST(VerifyKeptTravels, ASpiralStaysWithItsTravel) {
  const auto line = [](const char* y, const char* spiral) {
    return absl::StrCat("G1 E-1 F2100\nG17\n", spiral, " F9000\nG1 X0 Y", y,
                        " F9000\nG1 Z.2\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X9 Y", y,
                        " E.3\n");
  };
  const std::string right = "G3 Z.6 I1.2 J0 P1";
  for (const char* other : {"G3 Z.6 I0 J1.2 P1", "G2 Z.6 I1.2 J0 P1"}) {
    const std::string a = kHead + kOne + line("1", right.c_str()) + line("5", other);
    EXPECT_EQ(Kept(a, a), "") << other;
    EXPECT_EQ(Kept(a, kHead + kOne + line("1", other) + line("5", other)), "kept_travel") << other;
  }
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
    EXPECT_EQ(Kept(slow, fast), "");
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
