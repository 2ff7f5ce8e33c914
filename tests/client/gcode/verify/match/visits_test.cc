// Which paths of the original the other file prints: client/gcode/verify/match/visits.

#include "client/gcode/verify/match/visits.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

std::string Repeated(const std::string& text, int times) {
  std::string all = kHead;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

// Each is compared with a few others, not with all.
TEST(FindVisits, EqualLoopsInOnePlaceTakeNoLongerEach) {
  const auto check = [](int loops) {
    const std::string named = Repeated(kSquare, loops);
    const std::string unnamed = Repeated(With(kSquare, ";TYPE:External perimeter\n", ""), loops);
    EXPECT_EQ(Broken(named, named), "");
    EXPECT_EQ(Broken(named, Repeated(kSquareElsewhere, loops), Policy::kFree), "");
    EXPECT_EQ(Broken(unnamed, unnamed), "");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(2000, check), traverse::testing::kSlowGrowth);
}

// One of them is another one.
TEST(FindVisits, EqualLoopsAreTakenOnceEach) {
  const std::string a = Repeated(kSquare, 40) + kTwo;
  EXPECT_EQ(Broken(a, Repeated(kSquare, 40) + kTwo), "");
  EXPECT_EQ(Broken(a, Repeated(kSquare, 39) + kSquareTurned + kTwo), "direction");
  EXPECT_EQ(Broken(a, Repeated(kSquare, 41) + kTwo), "same_print");
}

// Rounding makes one line of the second loop another one. What is printed in one go begins where
// they are still alike, and goes on over their gaps.
TEST(FindVisits, LoopsOfOnePlaceThatDifferBehindTheirGapAreToldApart) {
  const std::string begin = Travel("X10 Y10") + ";TYPE:Internal infill\nG1 F1800\nG1 X20 Y10 E.4\n";
  const std::string up = "G1 X20 Y20 E.4\n";
  const std::string up_other = "G1 X20 Y20 E.40001\n";
  const std::string back = "G1 X10 Y20 E.4\nG1 X10 Y10.1 E.396\n";
  const std::string a = kHead + begin + up + back + begin + up_other + back;
  const std::string over = back + "G1 X10 Y10\nG1 X20 Y10 E.4\n";
  const std::string b =
      kHead + Travel("X20 Y20") + ";TYPE:Internal infill\nG1 F1800\n" + over + up_other + over + up;
  EXPECT_EQ(Broken(a, b, Policy::kFree), "");
}

// A loop of a nozzle of 1.8 mm that ends 0.27 mm short of its start, and the same begun elsewhere
// with its gap.
TEST(FindVisits, LoopsOfLargeNozzlesMayEndFartherFromTheirStart) {
  const std::string head = "M83\n;LAYER_CHANGE\nG1 Z.8 F9000\n";
  const auto square = [](const char* type, bool elsewhere, const char* width) {
    const std::string e = width;
    const std::string wall = std::string(";TYPE:") + type + "\nG1 F1800\n";
    if (!elsewhere) {
      return Travel("X10 Y10") + wall + "G1 X40 Y10 E" + e + "\nG1 X40 Y40 E" + e +
             "\nG1 X10 Y40 E" + e + "\nG1 X10 Y10.27 E" + e + "\n";
    }
    return Travel("X40 Y10") + wall + "G1 X40 Y40 E" + e + "\nG1 X10 Y40 E" + e +
           "\nG1 X10 Y10.27 E" + e + "\nG1 X10 Y10\nG1 X40 Y10 E" + e + "\n";
  };
  const char* const inner = "Perimeter";
  EXPECT_EQ(Broken(head + square(inner, false, "17.9"), head + square(inner, true, "17.9")), "");
  EXPECT_NE(Broken(head + square(inner, false, "1"), head + square(inner, true, "1")), "");
}

// The loop begins where the line before it, which is gone the other way, ends.
TEST(FindVisits, ALoopThatTakesItsGapAlongMayBeginWhereAnotherPathEnds) {
  const std::string wall = ";TYPE:Perimeter\nG1 F1800\n";
  const std::string line = ";TYPE:Internal infill\nG1 F1800\n";
  const std::string loop = Travel("X10 Y10") + wall +
                           "G1 X20 Y10 E.4\nG1 X20 Y20 E.4\nG1 X10 Y20 E.4\nG1 X10 Y10.1 E.396\n";
  const std::string a =
      kHead + ";TYPE:Perimeter\n" + loop + Travel("X20 Y20") + wall + "G1 X29 Y29 E.5\n";
  const std::string b = kHead + ";TYPE:Perimeter\n" + Travel("X29 Y29") + wall +
                        "G1 X20 Y20 E.5\n" +
                        "G1 X10 Y20 E.4\nG1 X10 Y10 E.4\nG1 X20 Y10 E.4\nG1 X20 Y19.9 E.396\n";
  VerifyPermissions permissions;
  permissions.policy = Policy::kFree;
  EXPECT_EQ(Broken(a, b, permissions, RuleBit(VerifyRule::kSamePrint)), "");
  EXPECT_NE(Broken(a, With(b, "Y19.9 E.396", "Y19.8 E.396"), permissions,
                   RuleBit(VerifyRule::kSamePrint)),
            "");
}

}  // namespace
}  // namespace traverse::gcode
