// Travel across outer walls without a retraction: client/gcode/verify/rules/travel/open_travel.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyOpenTravels, NoRetractionIsLostAcrossAnOuterWall) {
  const std::string open = With(kAcross, Travel("X30 Y15"), "G1 X30 Y15 F9000\n");
  EXPECT_EQ(Broken(kHead + kAcross, kHead + open), "open_travel");
  EXPECT_EQ(Broken(kHead + kAcross, kHead + open, Policy::kFree), "open_travel");
  // Nor comes filament back before the wall.
  const std::string early = With(kAcross, Travel("X30 Y15"),
                                 "G1 E-1 F2100\nG1 X18 Y15 F9000\nG1 E1 F2100\nG1 X30 Y15 F9000\n");
  EXPECT_EQ(Broken(kHead + kAcross, kHead + early), "open_travel");
}

// Between their ends such arcs lie far from the line that joins these.
TEST(VerifyOpenTravels, NoRetractionIsLostAcrossACircleOfArcsByRadius) {
  const std::string circle = Travel("X10 Y15") + kWall + "G3 X20 Y15 R5 E.6\nG3 X10 Y15 R5 E.6\n";
  const std::string a = circle + Line("Internal infill", "X14 Y17", "X15 Y17") +
                        Line("Internal infill", "X15 Y30", "X16 Y30");
  const std::string open = With(a, Travel("X15 Y30"), "G1 X15 Y30 F9000\n");
  EXPECT_EQ(Broken(kHead + a, kHead + open), "open_travel");
  // The long way round.
  const std::string large = Travel("X10 Y15") + kWall + "G2 X10 Y16 R-5 E3\nG1 X10 Y15 E.1\n";
  const std::string into = large + Line("Internal infill", "X5 Y40", "X6 Y40") +
                           Line("Internal infill", "X5 Y17", "X6 Y17");
  EXPECT_EQ(Broken(kHead + into, kHead + With(into, Travel("X5 Y17"), "G1 X5 Y17 F9000\n")),
            "open_travel");
}

TEST(VerifyOpenTravels, WithinTheWallAreFree) {
  const std::string within = kSquare + Line("Internal infill", "X15 Y15", "X16 Y15") +
                             Line("Internal infill", "X12 Y18", "X13 Y18") +
                             "G1 X16 Y16 F9000\nG1 F1800\nG1 X17 Y16 E.3\n";
  const std::string turned = With(With(within, Travel("X12 Y18"), "G1 X13 Y18 F9000\n"),
                                  "G1 X13 Y18 E.3", "G1 X12 Y18 E.3");
  EXPECT_EQ(Broken(kHead + within, kHead + turned), "");
}

// Over the corner of a wall, though not across its middle.
TEST(VerifyOpenTravels, NoRetractionIsLostOverAnOuterWallThatIsNotCrossed) {
  const auto broken = [](const std::string& from, const std::string& to) {
    const std::string one = kSquare + Line("Internal infill", "X5 Y5", from);
    const std::string other = Line("Internal infill", to, "X5 Y20");
    const std::string far =
        Line("Internal infill", "X0 Y40", "X5 Y40") + "G1 X5 Y55 F9000\nG1 F1800\nG1 X6 Y55 E.3\n";
    return Broken(kHead + one + far + other,
                  kHead + one + With(other, Travel(to), "G1 " + to + " F9000\n") + far);
  };

  EXPECT_EQ(broken("X14.95 Y5", "X5 Y14.95"), "open_travel");
  EXPECT_EQ(broken("X14 Y5", "X5 Y14"), "");
  // Along it, as it begins and ends; and away from it.
  EXPECT_EQ(broken("X9.95 Y12", "X9.95 Y18"), "");
  EXPECT_EQ(broken("X10 Y12", "X5 Y18"), "");
}

// The travel leaves the floor of two bays, and comes back to the tip between them.
TEST(VerifyOpenTravels, NoRetractionIsLostOverAnotherPartOfTheWallThatItLeaves) {
  const auto broken = [](const std::string& tip) {
    const std::string bays =
        Travel("X0 Y0") + kWall + "G1 X20 Y0 E1\nG1 X20 Y9 E1\nG1 X11 Y9 E1\nG1 " + tip +
        " E1\nG1 X9 Y9 E1\nG1 X0 Y9 E1\nG1 X0 Y0 E1\n" + Line("Internal infill", "X1 Y0", "X4 Y0");
    const std::string far =
        Line("Internal infill", "X0 Y40", "X5 Y40") + "G1 X5 Y55 F9000\nG1 F1800\nG1 X6 Y55 E.3\n";
    const std::string other = Line("Internal infill", "X16 Y4", "X16 Y5");
    const std::string open = With(other, Travel("X16 Y4"), "G1 X16 Y4 F9000\n");
    return Broken(kHead + bays + far + other, kHead + bays + open + far);
  };

  EXPECT_EQ(broken("X10 Y2.07"), "open_travel");
  EXPECT_EQ(broken("X10 Y3"), "");
}

TEST(VerifyOpenTravels, AcrossWallsGetNoLonger) {
  const std::string to_and_fro = With(kAcross, Travel("X30 Y15"), "G1 X30 Y15 F9000\n");
  const std::string longer =
      kSquare + Line("Internal infill", "X30 Y15", "X31 Y15") +
      With(Line("Internal infill", "X15 Y15", "X16 Y15"), Travel("X15 Y15"), "G1 X15 Y15 F9000\n");
  EXPECT_EQ(Broken(kHead + to_and_fro, kHead + longer), "open_travel");
}

TEST(VerifyOpenTravels, AcrossWallsMayBeAsLongElsewhere) {
  const std::string open = "G1 X30 Y15 F9000\n";
  const std::string further = "G1 X30 Y17 F9000\n";
  const std::string a =
      kSquare + Line("Internal infill", "X15 Y15", "X16 Y15") +
      With(Line("Internal infill", "X30 Y15", "X31 Y15"), Travel("X30 Y15"), open) +
      Line("Internal infill", "X15 Y17", "X16 Y17") + Line("Internal infill", "X28 Y17", "X30 Y17");
  // With the last line the other way round: the travel to it is another one.
  const std::string b = With(With(With(a, open, Travel("X30 Y15")), Travel("X28 Y17"), further),
                             "G1 X30 Y17 E.3", "G1 X28 Y17 E.3");

  EXPECT_EQ(Broken(kHead + a, kHead + b), "");
}

// What goes on along the wall ends on it, so that the travel from there begins on it as well.
TEST(VerifyOpenTravels, BeginWhereTheMoveAlongTheWallEnds) {
  const std::string wall = kSquare + "G1 X10.4 Y10\n";
  const std::string inside = ";TYPE:Internal infill\nG1 F1800\nG1 X15 Y10.6 E.3\n";
  const std::string a =
      kHead + wall + Line("Internal infill", "X12 Y15", "X18 Y15") + Travel("X10.5 Y10.6") + inside;
  const std::string b = kHead + wall + "G1 X10.5 Y10.6 F9000\n" + inside +
                        Line("Internal infill", "X12 Y15", "X18 Y15");

  EXPECT_EQ(Broken(a, b), "");
  // From beyond the wall it leads across it.
  EXPECT_EQ(
      Broken(a, With(b, "G1 X10.5 Y10.6 F9000\n", "G1 X10.5 Y9 F9000\nG1 X10.5 Y10.6 F9000\n")),
      "open_travel bounds");
}

// Some layers are reached with an open nozzle; where one is reached with filament pulled back, as
// no longer travel is, the next file does the same.
TEST(VerifyOpenTravels, LeadToLayersAsTheyDid) {
  const std::string infill = ";TYPE:Internal infill\nG1 F1800\n";
  const std::string third = ";LAYER_CHANGE\nG1 Z.6 F9000\n";
  const std::string a = kHead + kTwo + kNextLayer + Travel("X9 Y5.4") + infill +
                        "G1 X0 Y5.4 E.3\n" + third + "G1 X4 Y8 F9000\n" + infill + "G1 X0 Y8 E.3\n";
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, Travel("X9 Y5.4"), "G1 X9 Y5.4 F9000\n")), "open_travel");
  EXPECT_EQ(Broken(a,
                   With(a, "G1 X4 Y8 F9000\n" + infill + "G1 X0 Y8",
                        "G1 X0 Y8 F9000\n" + infill + "G1 X4 Y8"),
                   Policy::kFree),
            "");
}

// Nor does a retraction get lost on a shorter travel than any of the original.
TEST(VerifyOpenTravels, LeadToNoLayerIfNoneDid) {
  const std::string near = Line("Internal infill", "X9 Y5.4", "X0 Y5.4");
  const std::string far = Line("Internal infill", "X0 Y30", "X9 Y30");
  const std::string a = kHead + kTwo + kNextLayer + far + near;
  const std::string b = kHead + kTwo + kNextLayer + near + far;
  EXPECT_EQ(Broken(a, b), "");
  const std::string open = With(b, Travel("X9 Y5.4"), "G1 X9 Y5.4 F9000\n");
  EXPECT_EQ(Broken(a, open), "open_travel");
  // Whether it retracted at once there or not.
  const std::string leave = "G1 X9.3 Y5.2 F9000\n";
  const std::string left = With(a, kNextLayer, leave + "G1 E-1 F2100\n" + kNextLayer);
  const std::string was = With(left, Travel("X0 Y30"), "G1 X0 Y30 F9000\nG1 E1 F2100\n");
  EXPECT_EQ(Broken(was, was), "");
  EXPECT_THAT(Broken(was, With(open, kNextLayer, leave + kNextLayer)), HasSubstr("open_travel"));
  // Unless the original has one.
  const std::string third = ";LAYER_CHANGE\nG1 Z.6 F9000\n";
  const std::string last = ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y5.8 E.3\n";
  const std::string as_far = third + "G1 X0 Y5.8 F9000\n" + last;
  EXPECT_EQ(Broken(a + as_far, open + third + Travel("X0 Y5.8") + last), "");
}

// How travel leaves its path before it retracts is no open travel, wherever it leads.
TEST(VerifyOpenTravels, AreNoDeparturesOnTheWayToALayer) {
  const std::string wall = kSquare + "G1 X10.3 Y10.3 F9000\n";
  const std::string next = kNextLayer + Line("Internal infill", "X9.3 Y5", "X0 Y5.4");
  const std::string a = kHead + wall + kOther + next;
  const std::string b = kHead + kOther + wall + next;
  EXPECT_EQ(Broken(a, b), "");
  // Without a retraction behind it, it is.
  EXPECT_THAT(Broken(a, With(b, Travel("X9.3 Y5"), "G1 X9.3 Y5 F9000\n")),
              HasSubstr("open_travel"));
}

TEST(VerifyOpenTravels, AreNoLongerThanTheLongestWhateverTheyCross) {
  const std::string far = Line("Internal infill", "X80 Y5", "X89 Y5");
  const std::string near = kOne + "G1 X9 Y2 F9000\nG1 F1800\nG1 X0 Y2 E.3\n";
  const std::string open = With(far, Travel("X80 Y5"), "G1 X80 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + near + far, kHead + near + open), "open_travel");
  EXPECT_EQ(Broken(kHead + near + open, kHead + near + open), "");
}

TEST(VerifyOpenTravels, LeadToALayerWhereSuchDo) {
  const std::string next = ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  const std::string a = kHead + kOne + "G1 X9 Y3 F9000\nG1 F1800\nG1 X0 Y3 E.3\n" + next;
  const std::string open = With(kOther, Travel("X0 Y5"), "G1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(a + kOther, a + open), "open_travel");
  EXPECT_EQ(Broken(a + open, a + kOther), "");
}

// Each with each of the original it would be ten billion pairs, and minutes.
TEST(VerifyOpenTravels, ManyThatAreNewTakeNoLongerEach) {
  const auto check = [](int lines) {
    const std::string far = "G1 X0 Y-5 F9000\nG1 X1 Y-5 E.03 F1200\n";
    std::string a = kHead + ";TYPE:Internal infill\n" + far;
    std::string b = a;
    const auto add = [](int line, std::string& text) {
      absl::StrAppend(&text, "G1 X0 Y", 0.4 * line, " F9000\nG1 X1 Y", 0.4 * line, " E.03 F1200\n");
    };
    for (int line = 0; line < lines; line += 2) {
      add(line, a);
      add(line + 1, a);
      add(line + 1, b);
      add(line, b);
    }
    EXPECT_EQ(Broken(a, b, Policy::kFree), "");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(10'000, check), traverse::testing::kSlowGrowth);
}

// Loops of a few thousandths of a millimeter, all of them in a square of a third of a millimeter:
// each move between them comes right over hundreds.
TEST(VerifyOpenTravels, InACrowdOfLoopsTakeNoLongerEach) {
  const auto check = [](int loops) {
    std::string was = kHead + ";TYPE:External perimeter\n";
    for (int i = 0; i < loops; ++i) {
      const int place = static_cast<int>(int64_t{i} * 7919 % loops);
      const double x = 0.003 * (place % 100);
      const double y = 0.3 * place / loops;
      absl::StrAppendFormat(&was, "G1 X%.3f Y%.3f F9000\nG1 F1200\n", x, y);
      absl::StrAppendFormat(&was, "G1 X%.3f E.1\nG1 Y%.3f E.1\nG1 X%.3f Y%.3f E.1\n", x + 0.003,
                            y + 0.003, x, y);
    }
    EXPECT_EQ(Broken(was, was), "");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(2000, check), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
