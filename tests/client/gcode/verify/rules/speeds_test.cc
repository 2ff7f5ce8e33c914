// Speeds and accelerations of travel and retractions:
// client/gcode/verify/rules/{speeds,travel/made_of_parts}.

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

// By which speeds are proven.
std::string Fast(const std::string& original, const std::string& optimised) {
  return Broken(original, optimised, {},
                RuleBit(VerifyRule::kSamePrint) | RuleBit(VerifyRule::kMadeOfParts));
}

TEST(VerifySpeeds, AreThoseOfSuchMoves) {
  EXPECT_EQ(Fast(kHead + kTwo, kHead + kOneTurned), "");
  EXPECT_EQ(Fast(kHead + kTwo, kHead + With(kOneTurned, "X9 Y0 F9000", "X9 Y0 F1800")),
            "made_of_parts");
  EXPECT_EQ(Fast(kHead + kTwo, kHead + With(kOneTurned, "G1 E-1 F2100", "G1 E-1 F1800")),
            "made_of_parts");
}

// The first layer may have travel moves of its own speed, and so may any other.
TEST(VerifySpeeds, TravelsAreAsFastAsThoseOfTheirLayer) {
  const std::string first = With(kTwo, "X0 Y0 F9000", "X0 Y0 F3000");
  const std::string slow = With(first, "X0 Y5 F9000", "X0 Y5 F3000");
  const std::string a = kHead + slow + kNextLayer + kTwo;
  EXPECT_EQ(Fast(a, kHead + slow + kNextLayer + kOneTurned), "");
  const std::string b = kHead + slow + kNextLayer + With(kOneTurned, "X9 Y0 F9000", "X9 Y0 F3000");
  EXPECT_EQ(Fast(a, b), "made_of_parts");
}

// Where all filament is pulled back behind lines that are not known, these are its speeds.
TEST(VerifySpeeds, BehindUnknownLinesAreThoseOfTheOriginalThere) {
  const auto begun = [](const std::string& first, const std::string& second) {
    return kHead + "P0 S1 L2 D0\n" + Travel(first) + ";TYPE:Internal infill\nG1 F1800\n" + second;
  };
  const std::string a = begun("X0 Y0", "G1 X9 Y0 E.3\nG1 X0 Y5 F9000\nG1 F1800\nG1 X9 Y5 E.3\n");
  const std::string b = begun("X0 Y5", "G1 X9 Y5 E.3\nG1 X0 Y0 F9000\nG1 F1800\nG1 X9 Y0 E.3\n");
  EXPECT_EQ(Fast(a, b), "");
  EXPECT_EQ(Broken(a, With(b, "G1 E1 F2100", "G1 E1 F1800")), "scripts");
}

// A layer without retracted travel shows how fast that is all the same.
TEST(VerifySpeeds, RetractedTravelOfALayerThatHasNoneIsAsFastAsItsOtherTravel) {
  const auto open = [](const std::string& from, const std::string& to) {
    return absl::StrCat("G1 ", from, " F7500\n;TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
  };
  const std::string first = kHead + kTwo + kNextLayer;
  const std::string a = first + open("X0 Y0", "X9 Y0") + open("X0 Y5", "X9 Y5");
  const std::string other = open("X0 Y5", "X9 Y5");
  const std::string b = first + "G1 E-1 F2100\n" + With(other, "F7500\n", "F7500\nG1 E1 F2100\n") +
                        open("X0 Y0", "X9 Y0");
  EXPECT_EQ(FirstMessage(a, b).find("travel at F7500"), std::string::npos) << FirstMessage(a, b);
}

// Each place where they are new is named.
TEST(VerifySpeeds, EachLinkThatHasAnotherSpeedIsNamed) {
  const std::string a = kHead + kTwo + kNextLayer + kTwo;
  const std::string slow =
      With(With(kOneTurned, "G1 E-1 F2100", "G1 E-1 F1700"), "G1 E-1 F2100", "G1 E-1 F1700");
  const VerifyReport report = CheckGcode(a, "a", kHead + slow + kNextLayer + slow, "b", {});
  size_t named = 0;
  for (const VerifyBreak& found : report.breaks) {
    if (found.message.find("goes at the speed of retraction") != std::string::npos) {
      ++named;
    }
  }
  EXPECT_EQ(named, 4u);
}

// So are moves as short as the gap of a loop, unless they are as fast as the loop is printed.
TEST(VerifySpeeds, ShortMovesAreAsFastAsOthers) {
  const std::string loop = With(kSquare, "G1 X10 Y10 E.4\n", "G1 X10 Y10.1 E.4\n");
  const std::string a = kHead + loop + "G1 X10 Y10 F9000\n" + kOther;
  EXPECT_EQ(Fast(a, a), "");
  EXPECT_EQ(Fast(a, With(a, "G1 X10 Y10 F9000\nG1 E-1", "G1 X10 Y10 F9600\nG1 E-1")),
            "made_of_parts");
}

// What another layer does at the speed of its travel is no example.
TEST(VerifySpeeds, RetractionsAreAsFastAsThoseOfTheirLayer) {
  const auto pulled_as_fast_as_travel = [](const std::string& text) {
    return With(text, "G1 E-1 F2100", "G1 E-1 F9000");
  };
  const auto pushed_as_fast_as_travel = [](const std::string& text) {
    return With(text, "G1 E1 F2100", "G1 E1 F9000");
  };
  const std::string fast = pushed_as_fast_as_travel(pulled_as_fast_as_travel(kTwo));
  const std::string a = kHead + fast + kNextLayer + kTwo;
  EXPECT_EQ(Fast(a, kHead + fast + kNextLayer + kOneTurned), "");
  const std::string pulled = kHead + fast + kNextLayer + pulled_as_fast_as_travel(kOneTurned);
  EXPECT_EQ(Fast(a, pulled), "made_of_parts");
  EXPECT_EQ(Fast(a, kHead + fast + kNextLayer + pushed_as_fast_as_travel(kOneTurned)),
            "made_of_parts");
}

// Behind the last path the end script pulls filament back as well, at a speed of its own.
TEST(VerifySpeeds, TheLastRetractionIsAsFastAsTheOthers) {
  const std::string end =
      "G1 E-1 F2100\n;TIME_ELAPSED:9\nM107\nG1 E-2 F2700\nG1 X0 Y200 F3000\nM84\n";
  const std::string a = kHead + kTwo + end;
  EXPECT_EQ(Fast(a, kHead + kTwo + With(end, "E-1 F2100", "E-1 F1050")), "made_of_parts");
  EXPECT_EQ(Fast(a, kHead + Line("Internal infill", "X0 Y0", "X9 Y0") +
                        Line("Internal infill", "X9 Y5", "X0 Y5") + end),
            "");
}

// A tail on its way to a line that nobody knows is one that the original does.
TEST(VerifySpeeds, ATailInAFixedTravelIsAsItWas) {
  const std::string a =
      "G1 F1200 X20 Y10 E.4\nG1 X10 Y20 E1.2\nG1 X10 Y10.5 E1.58\nG0 F1080 X10 Y10\n"
      "G30001 F2400\nG1 F1200 X18 Y30 E2.5\n";
  EXPECT_EQ(Fast(a, a), "");
  EXPECT_NE(Broken(a, With(a, "F1080", "F1060")), "");
}

TEST(VerifySpeeds, TravelKeepsItsAcceleration) {
  const auto path = [](const std::string& from, const std::string& to) {
    return absl::StrCat("M204 P1000\n",
                        With(Line("Internal infill", from, to), "G1 F1800", "M204 P500\nG1 F1800"));
  };
  const std::string two = path("X0 Y0", "X9 Y0") + path("X0 Y5", "X9 Y5");
  EXPECT_EQ(Broken(kHead + two, kHead + path("X9 Y0", "X0 Y0") + path("X0 Y5", "X9 Y5")), "");
  EXPECT_EQ(Broken(kHead + two,
                   kHead + With(path("X9 Y0", "X0 Y0"), "P1000", "P900") + path("X0 Y5", "X9 Y5")),
            "speeds");
}

// Each line printed under an acceleration of its own, all travel moves under one.
std::string Accelerated(const std::string& from, const std::string& to, int print) {
  return absl::StrCat("G1 E-1 F2100\nM204 S1000\nG1 ", from, " F9000\nG1 E1 F2100\nM204 S", print,
                      "\n;TYPE:Internal infill\nG1 F1800\nG1 ", to, " E.3\n");
}

TEST(VerifySpeeds, RetractionsKeepTheirAccelerations) {
  const std::string a = kHead + "M204 S1000\n" + Accelerated("X0 Y0", "X9 Y0", 300) +
                        Accelerated("X0 Y5", "X9 Y5", 400) + Accelerated("X0 Y9", "X9 Y9", 500);
  // Under that of whatever path comes before.
  const std::string other = kHead + "M204 S1000\n" + Accelerated("X0 Y9", "X9 Y9", 500) +
                            Accelerated("X0 Y0", "X9 Y0", 300) + Accelerated("X0 Y5", "X9 Y5", 400);
  EXPECT_EQ(Broken(a, other), "");
  EXPECT_EQ(
      Broken(a, With(other, "E.3\nG1 E-1 F2100\n", "E.3\nM204 S777\nG1 E-1 F2100\nM204 S1000\n")),
      "speeds");
}

TEST(VerifySpeeds, TheAccelerationOfRetractionsIsOneOfThem) {
  const std::string a = kHead + "M204 P500 R900 T1000\n" + kTwo;
  const std::string b = kHead + "M204 P500 R900 T1000\n" +
                        With(kTwo, Travel("X0 Y5"),
                             "M204 P500 R90 T1000\n" + Travel("X0 Y5") + "M204 P500 R900 T1000\n");
  EXPECT_EQ(Broken(a, b), "speeds");
}

// Some slicers accelerate less on short ways.
TEST(VerifySpeeds, LongTravelsAreNotUnderTheAccelerationOfShortOnes) {
  const std::string slow = "M204 T250\n";
  const std::string fast = "M204 T5000\n";
  const std::string a = kHead + fast + Line("Internal infill", "X0 Y0", "X9 Y0") +
                        Line("Internal infill", "X30 Y30", "X39 Y30") + slow +
                        Line("Internal infill", "X40 Y30", "X49 Y30") + fast +
                        Line("Internal infill", "X10 Y10", "X19 Y10");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, "M204 T5000\nG1 E-1 F2100\nG1 X10", "G1 E-1 F2100\nG1 X10") + fast),
            "speeds");
}

// Where an acceleration is stated before the travel to a path, it is that path's. Slicers let the
// nozzle run dry over the end of a path: that is no travel.
TEST(VerifySpeeds, LongTravelIsUnderTheAccelerationOfThePathThatItLeadsTo) {
  for (const bool runs_dry : {false, true}) {
    const auto path = [&](int x, int acceleration) {
      const std::string dry = runs_dry ? absl::StrCat("G1 X", x + 9, "\n") : "";
      return absl::StrCat(
          "M204 S", acceleration, "\n",
          Line("Internal infill", absl::StrCat("X", x, " Y0"), absl::StrCat("X", x + 8.6, " Y0")),
          dry);
    };
    const std::string head = kHead + "M204 S800\n";
    const std::string a = head + path(0, 800) + path(12, 1200) + path(100, 800) + path(300, 800);
    const std::string b = head + path(0, 800) + path(100, 800) + path(12, 1200) + path(300, 800);

    EXPECT_EQ(Broken(a, b, {}, RuleBit(VerifyRule::kSpeeds)), "") << runs_dry;
  }
}

}  // namespace
}  // namespace traverse::gcode
