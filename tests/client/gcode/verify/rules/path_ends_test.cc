// What follows a path without filament: client/gcode/verify/rules/path_ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

// A line of infill that goes on for 0.04 mm without filament.
std::string Tailed(const std::string& from, const std::string& to, const std::string& on) {
  return absl::StrCat(Line("Internal infill", from, to), "G1 ", on, "\n");
}

TEST(VerifyPathEnds, StayWithTheirPaths) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "")), "path_ends");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "G1 X9.2 Y0\n")), "path_ends");
}

// By 0.02 mm: coordinates of two decimals round by less. And from where the path ends none is new.
TEST(VerifyPathEnds, AreAsLongAsTheyWere) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "G1 X9.02 Y0\n")), "path_ends");
  EXPECT_EQ(Broken(kHead + two, kHead + With(two, "G1 X9.04 Y0\n", "G1 X9.03 Y0\n")), "");
  const std::string again = kHead + two + kOne + kOther;
  const std::string on = kOne + "G1 X9.1 Y0\n" + kOther;
  EXPECT_EQ(Broken(again, kHead + two + on), "path_ends");
}

// A long path, and as many moves that go back along it, slowly or as fast as travel.
TEST(VerifyPathEnds, AreComparedWithLongPathsInLinearTime) {
  for (const char* const feed : {"", " F9000"}) {
    const auto check = [feed](int lines) {
      std::string there = Line("Internal infill", "X0 Y0", "X1 Y0");
      std::string back;
      for (int i = 1; i <= lines; ++i) {
        const std::string at = absl::StrFormat("G1 X%d Y%.3f", i * 37 % 100, i * 200.0 / lines);
        absl::StrAppend(&there, at, " E.3\n");
        back.insert(0, absl::StrCat(at, feed, "\n"));
      }
      const std::string print = kHead + there + back + kOther;
      EXPECT_EQ(Broken(print, print), "");
    };
    EXPECT_LT(traverse::testing::GrowthOfFour(8000, check), traverse::testing::kSlowGrowth) << feed;
  }
}

// A loop that begins elsewhere goes on no farther than its gap.
TEST(VerifyPathEnds, NoneIsNewBehindALoopThatBeginsElsewhere) {
  const std::string a = kHead + kSquare + kOne;
  const auto on = [](const std::string& beyond) {
    return kHead + kSquareElsewhere + "G1 " + beyond + "\n" + kOne;
  };
  EXPECT_EQ(Broken(a, on("X20.01 Y10"), Policy::kFree), "");
  EXPECT_EQ(Broken(a, on("X20.1 Y10"), Policy::kFree), "path_ends");
}

TEST(VerifyPathEnds, TurnWithTheirPaths) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  const std::string turned =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X9 Y5", "X0 Y5", "X-.04 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + turned), "");
  EXPECT_EQ(Broken(kHead + two, kHead + With(turned, "X-.04 Y5", "X.04 Y5")), "path_ends");
}

// It begins on the line, and goes on round the corner that the path would have had: as far, turned,
// goes a straight one.
TEST(VerifyPathEnds, CoastingMayGoRoundCorners) {
  for (const std::string bent :
       {"X9.03 Y0\nG1 X9.19 Y.03", "X9.1 Y0\nG1 X9.1 Y.1", "X9.1 Y0\nG1 X9 Y.03"}) {
    const std::string two =
        Line("Internal infill", "X0 Y5", "X9 Y5") + Tailed("X0 Y0", "X9 Y0", bent);
    const auto turned = [&two](const std::string& on) {
      return Broken(kHead + two, kHead + Line("Internal infill", "X0 Y5", "X9 Y5") +
                                     Tailed("X9 Y0", "X0 Y0", on));
    };
    EXPECT_EQ(turned("X-.2 Y0"), "") << bent;
    EXPECT_EQ(turned("X-.1 Y0"), "path_ends") << bent;
    EXPECT_EQ(turned("X.2 Y0"), "path_ends") << bent;
    EXPECT_EQ(Broken(kHead + two, kHead + With(two, bent, "X9.2 Y0")), "path_ends") << bent;
    EXPECT_THAT(Broken(kHead + With(two, "G1 " + bent + "\n", ""), kHead + two),
                HasSubstr("path_ends"))
        << bent;
  }
}

// The travel from line to line of a zigzag, of which nothing is left to print, lies along the line.
TEST(VerifyPathEnds, AreNoTravelsToTheNextPath) {
  const std::string line = Line("Internal infill", "X0 Y0", "X9 Y0");
  const std::string open = "G1 X8 Y20 F1800\nG1 X9 Y20 E.3\n";
  const std::string a = kHead + open + line + "G1 X8.92 Y.03\nG1 X0 Y.8 E.3\n";
  const std::string b = kHead + open + Line("Internal infill", "X8.92 Y.03", "X0 Y.8") + line;
  EXPECT_EQ(Broken(a, b), "");
  EXPECT_EQ(Broken(a, With(a, "G1 X8.92 Y.03\n", "")), "same_print");
}

// As fast as the path, but off to one side, to where the next path begins: an example for travel.
TEST(VerifyPathEnds, AShortSlowMoveToOneSideIsTravel) {
  const auto line = [](const std::string& from, const std::string& to) {
    return "G1 " + from + "\nG1 " + to + " E.3 F1800\n";
  };
  const std::string type = kHead + ";TYPE:Internal infill\n";
  const std::string gap = line("X0 Y0 F9000", "X9 Y0") + line("X9.07 Y.04", "X9.07 Y9");
  const std::string first = line("X20 Y0 F9000", "X29 Y0");
  const std::string apart = line("X40 Y0 F9000", "X49 Y0");
  const std::string a = type + gap + first + apart + line("X29.5 Y.4 F9000", "X29.5 Y9");
  EXPECT_EQ(Broken(a, type + gap + first + line("X29.5 Y.4", "X29.5 Y9") + apart), "");
}

// So short a move to the inside is near to the wall: it leaves it, where it retracts. (OrcaSlicer's
// are a fifth of the nozzle.)
TEST(VerifyPathEnds, AShortMoveInwardsIsNoTail) {
  const std::string aside = "G1 X10.077 Y10.021\n";
  const std::string near = ";TYPE:Internal infill\nG1 X11 Y11 F9000\nG1 F1800\nG1 X19 Y11 E.3\n";
  const std::string far = Line("Internal infill", "X11 Y15", "X19 Y15");
  const std::string a = kHead + near + kSquare + aside + far;
  const std::string b = kHead + kSquare + near + far;
  EXPECT_EQ(Broken(a, b), "");
  EXPECT_EQ(Broken(With(a, aside, "G1 X10.077 Y10.004\n"), b), "path_ends");
}

// Where travel is as fast as printing, what lies along a path may be the travel to the next one.
TEST(VerifyPathEnds, AreNoneWhereTravelIsAsFastAsThePath) {
  const auto line = [](const std::string& from, const std::string& to) {
    return "G1 " + from + "\nG1 " + to + " E.3\n";
  };
  const std::string type = kHead + ";TYPE:Internal infill\nG1 F9000\n";
  // From the first to the second line it leads along the first one, and from the third to the
  // first.
  const std::string first = line("X0 Y0", "X9 Y0");
  const std::string second = line("X9.5 Y0\nG1 X12 Y1", "X12 Y9");
  const std::string third = line("X3 Y0", "X3 Y-9");
  const std::string a = type + first + second + third;
  const std::string b = type + third + first + With(second, "X9.5 Y0\nG1 ", "");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_THAT(Broken(a, b), Not(HasSubstr("path_ends")));
  const std::string c = type + With(second, "X9.5 Y0\nG1 ", "") + third + first;
  EXPECT_THAT(Broken(a, c), Not(HasSubstr("path_ends")));
  // Where it is faster, none may be missing.
  const std::string fast = With(a, "G1 X12 Y1\n", "G1 X12 Y1 F12000\n");
  EXPECT_THAT(Broken(fast, With(fast, "G1 X9.5 Y0\n", "")), HasSubstr("path_ends"));
}

// At its own feed rate, which no way has; the travel to the next layer begins with it.
TEST(VerifyPathEnds, AreNoTravelsAtTheEndOfALayer) {
  const std::string one = With(Tailed("X0 Y0", "X9 Y0", "X9.2 Y0"), "F1800", "F1556");
  const std::string other = Tailed("X0 Y5", "X9 Y5", "X9.2 Y5");
  const std::string next = kNextLayer + kTwo;
  EXPECT_EQ(Broken(kHead + one + other + next, kHead + other + one + next), "");
  const std::string slow = With(next, "G1 X0 Y0 F9000", "G1 X0 Y0 F1556");
  EXPECT_EQ(Broken(kHead + one + other + next, kHead + other + one + slow, {},
                   RuleBit(VerifyRule::kSamePrint) | RuleBit(VerifyRule::kMadeOfParts)),
            "made_of_parts");
}

// Each at its own, whatever speeds there are beside it.
TEST(VerifyPathEnds, KeepTheirSpeeds) {
  const std::string two =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X0 Y5", "X9 Y5", "X9.04 Y5");
  const std::string turned =
      Tailed("X0 Y0", "X9 Y0", "X9.04 Y0") + Tailed("X9 Y5", "X0 Y5", "X-.04 Y5");
  const std::string slow = With(turned, "X-.04 Y5", "X-.04 Y5 F900");
  EXPECT_EQ(Broken(kHead + two, kHead + slow), "path_ends");
  const std::string third = Tailed("X0 Y9", "X9 Y9", "X9.04 Y9 F900");
  const std::string last = Line("Internal infill", "X0 Y20", "X9 Y20");
  EXPECT_EQ(Broken(kHead + third + two + last, kHead + third + slow + last), "path_ends");
  EXPECT_EQ(Broken(kHead + With(two, "X9.04 Y5", "X9.04 Y5 F900"), kHead + slow), "");
}

// Where another path follows than in the original, so that the travel there has no example.
TEST(VerifyPathEnds, NoOpenNozzleGoesBackAlongAPathAndReturns) {
  const std::string first = kOther + "G1 X7 Y5 F9000\n";
  const std::string third = Line("Internal infill", "X0 Y9", "X9 Y9");
  const std::string fourth = Line("Internal infill", "X0 Y20", "X9 Y20");
  const std::string last = Line("Internal infill", "X0 Y30", "X9 Y30");
  const std::string poke = "G1 X8.7 Y0 F9000\nG1 X9 Y0\n";
  const std::string a = kHead + first + kOne + third + fourth + last;
  EXPECT_EQ(Broken(a, kHead + first + third + kOne + fourth + last), "");
  EXPECT_EQ(Broken(a, kHead + first + third + kOne + poke + fourth + last), "path_ends");
  // Unless the original does so elsewhere.
  const std::string poked = fourth + "G1 X8.7 Y20 F9000\nG1 X9 Y20\n" + last;
  EXPECT_EQ(
      Broken(kHead + first + kOne + third + poked, kHead + first + third + kOne + poke + poked),
      "");
}

// As Cura wipes outer walls: 0.2 mm over the begin of the loop, as fast as travel, whatever
// follows.
TEST(VerifyPathEnds, TravelGoesOnAlongALoopWhereverThatEnds) {
  const std::string on = "G1 X10.2 Y10 F9000\n";
  const std::string inside = "G1 X15 Y15 F9000\n;TYPE:Internal infill\nG1 F1800\nG1 X16 Y15 E.3\n";
  const std::string pulled = Line("Internal infill", "X15 Y15", "X16 Y15");
  const std::string travel = "G1 X0 Y5 F9000\n;TYPE:Internal infill\nG1 F1800\nG1 X9 Y5 E.3\n";
  const std::string a = kHead + kOne + travel + kSquare + on + inside;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, kHead + kOne + kSquare + on + kOther + pulled), "");
  EXPECT_EQ(Broken(a, kHead + kOne + kSquare + kOther + pulled), "path_ends");
  const std::string elsewhere =
      kHead + kOne + travel + kSquareElsewhere + "G1 X20 Y10.2 F9000\n" + pulled;
  EXPECT_EQ(Broken(a, elsewhere, Policy::kFree), "");
  EXPECT_EQ(Broken(a, With(elsewhere, "G1 X20 Y10.2 F9000\n", ""), Policy::kFree), "path_ends");
  // A single move, or one to another side, leads to the next path.
  const std::string b = kHead + kOne + travel + kSquare + inside;
  EXPECT_EQ(Broken(b, kHead + kOne + kSquare + kOther + pulled), "");
}

// A straight move off a small loop ends beside where the loop would be after as much, but leads
// across it.
TEST(VerifyPathEnds, TravelAcrossASmallLoopDoesNotGoOnAlongIt) {
  constexpr int kSides = 24;
  std::string loop = Travel("X10.3 Y10") + ";TYPE:External perimeter\nG1 F1800\n";
  for (int side = 1; side <= kSides; ++side) {
    const double angle = 2 * std::numbers::pi * side / kSides;
    absl::StrAppendFormat(&loop, "G1 X%.3f Y%.3f E.01\n", 10 + 0.3 * std::cos(angle),
                          10 + 0.3 * std::sin(angle));
  }
  const std::string across = "G1 X10.053 Y10.314 F9000\n";
  const std::string a = kHead + loop + across + Line("Internal infill", "X15 Y15", "X16 Y15");
  EXPECT_EQ(Broken(a, a), "");
}

// The move inwards turns with the loop's start: to the same side, and as far.
TEST(VerifyPathEnds, TravelLeavesALoopThatBeginsElsewhereByTheSameMoveTurned) {
  const std::string leave = "G1 X10.4 Y10.3 F9000\n";
  const std::string inside = Line("Internal infill", "X15 Y15", "X16 Y15");
  const std::string a = kHead + kSquare + leave + inside + kOther;
  const auto elsewhere = [&](const std::string& move) {
    return Broken(a, kHead + kSquareElsewhere + move + inside + kOther, Policy::kFree);
  };
  EXPECT_EQ(elsewhere("G1 X19.7 Y10.4 F9000\n"), "");
  EXPECT_EQ(elsewhere(""), "") << "a move that would cross a wall is left out";
  EXPECT_EQ(elsewhere("G1 X19.6 Y10.3 F9000\n"), "path_ends bounds") << "another angle";
  EXPECT_EQ(elsewhere("G1 X20.3 Y10.4 F9000\n"), "path_ends bounds") << "another side";
  EXPECT_EQ(elsewhere("G1 X19.66 Y10.45 F9000\n"), "path_ends bounds") << "farther";
  // Without a retraction it leads to the next path.
  const std::string open = "G1 X15 Y15 F9000\n;TYPE:Internal infill\nG1 F1800\nG1 X16 Y15 E.3\n";
  const std::string b = kHead + kSquare + leave + open + kOther;
  const auto open_elsewhere = [&](const std::string& move) {
    return Broken(b, kHead + kSquareElsewhere + move + open + kOther, Policy::kFree);
  };
  EXPECT_EQ(open_elsewhere("G1 X19.7 Y10.4 F9000\n"), "");
  EXPECT_EQ(open_elsewhere("G1 X19.4 Y10.8 F9000\n"), "bounds");
}

// Retracted away from the wall, travel leaves no trace on it.
TEST(VerifyPathEnds, TravelThatLeavesAPathBeforeItRetractsDoesSo) {
  const std::string leave = "G1 X10.4 Y10.3 F9000\n";
  const std::string inside = Line("Internal infill", "X15 Y15", "X16 Y15");
  const std::string a = kHead + kSquare + leave + inside + kOther;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, leave, "")), "path_ends");
  // Wherever it leads to, so behind the last path of a layer too.
  const std::string other = Line("Internal infill", "X0 Y5", "X9 Y5");
  const std::string next =
      "G1 E-1 F2100\n;LAYER_CHANGE\nG1 Z.4 F9000\nG1 X0 Y5\nG1 E1 F2100\n;TYPE:Internal infill\n"
      "G1 F1800\nG1 X9 Y5 E.3\n";
  const std::string was = kHead + kSquare + leave + inside + other + next;
  const std::string elsewhere = kHead + kSquare + leave + other + inside + next;
  EXPECT_EQ(Broken(was, elsewhere), "");
  EXPECT_EQ(Broken(was, With(elsewhere, leave, "")), "path_ends");
  const std::string last = kHead + inside + other + kSquare + leave + next;
  EXPECT_EQ(Broken(was, last), "");
  EXPECT_EQ(Broken(was, With(last, leave, "")), "path_ends");
  // But what looks like this behind all kinds of paths may lead somewhere, unless all outer walls
  // are left so.
  const std::string aside = "G1 X9.3 Y5.2 F9000\n";
  const std::string with_aside = kHead + kSquare + leave + inside + other + aside + next;
  const std::string lost = kHead + inside + other + aside + kSquare + next;
  EXPECT_EQ(Broken(with_aside, lost), "path_ends");
  const std::string wall =
      Travel("X40 Y10") + kWall + "G1 X50 Y10 E.4\nG1 X40 Y20 E.4\nG1 X40 Y10 E.4\n";
  EXPECT_EQ(Broken(With(with_aside, inside, wall + inside), With(lost, inside, wall + inside)), "");
  // To the same side, whatever it leads to.
  EXPECT_EQ(Broken(a, With(a, leave, "G1 X10.3 Y10.4 F9000\n")), "path_ends bounds");
  EXPECT_EQ(Broken(was, With(elsewhere, leave, "G1 X9.6 Y10.3 F9000\n")), "path_ends bounds");
  EXPECT_EQ(Broken(With(a, leave, ""), a), "path_ends bounds") << "it did not leave it";
  // Straight on, from where the path ends now.
  const std::string turned =
      With(With(a, "G1 X15 Y15 F9000", "G1 X16 Y15 F9000"), "G1 X16 Y15 E.3", "G1 X15 Y15 E.3");
  EXPECT_EQ(Broken(a, turned), "");
  EXPECT_THAT(Broken(a, With(turned, "G1 X15 Y15 E.3\n", "G1 X15 Y15 E.3\nG1 X14.7 Y14.8 F9000\n")),
              HasSubstr("path_ends"));
  // Without a retraction it may go straight.
  const std::string straight = With(With(a, leave, ""), Travel("X15 Y15"), "G1 X15 Y15 F9000\n");
  EXPECT_EQ(Broken(a, straight).find("path_ends"), std::string::npos);
}

// Behind a move that goes on along the path, too, though others retract later.
TEST(VerifyPathEnds, TravelRetractsNoFartherBehindThePath) {
  const std::string late =
      kOther + "G1 X9 Y6.5 F9000\n" + Line("Internal infill", "X0 Y20", "X9 Y20");
  const auto print = [&](const std::string& before) {
    return kHead + kSquare + "G1 X10.2 Y10\n" + before + kOne + late;
  };
  const std::string a = print("");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, kHead + kSquare + "G1 X10.2 Y10\n" + late + kOne), "");
  EXPECT_THAT(Broken(a, print("G1 X9.4 Y9.4 F9000\n")), HasSubstr("path_ends"));
}

}  // namespace
}  // namespace traverse::gcode
