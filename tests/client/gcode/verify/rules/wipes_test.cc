// Wipes: client/gcode/verify/rules/wipes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyWipes, LieOnTheirPath) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  const std::string turned = Wiped("X9 Y5", "X0 Y5", "X2 Y5") + Wiped("X9 Y0", "X0 Y0", "X2 Y0");
  EXPECT_EQ(Broken(head + two, head + turned), "");
  const std::string beside = Wiped("X9 Y5", "X0 Y5", "X7 Y5.2") + Wiped("X9 Y0", "X0 Y0", "X2 Y0");
  EXPECT_EQ(Broken(head + two, head + beside), "wipes");
}

// A path of `lines` lines, and a wipe of `moves` moves of which the last leads `aside` mm aside.
std::string WipedLong(int lines, int moves, double aside) {
  std::string print = Line("Internal infill", "X0 Y0", "X1 Y0");
  for (int i = 1; i <= lines; ++i) {
    absl::StrAppendFormat(&print, "G1 X1 Y%.5f E.3\n", i * 50.0 / lines);
  }
  print += ";WIPE_START\n";
  for (int i = 1; i <= moves; ++i) {
    absl::StrAppendFormat(&print, "G1 X%g Y%.5f E-.0002 F7200\n", i == moves ? 1 + aside : 1,
                          50 - i * 50.0 / moves);
  }
  return print + ";WIPE_END\n";
}

TEST(VerifyWipes, AreFollowedAsFarAsSlicersLeadThem) {
  const auto file = [](const std::string& wiped) { return kHead + wiped + kOne; };
  EXPECT_EQ(Broken(file(WipedLong(9, 1000, 0)), file(WipedLong(9, 1000, .01))), "");
  EXPECT_THAT(FirstMessage(file(WipedLong(9, 1000, 0)), file(WipedLong(9, 1000, .2))),
              HasSubstr("leads 0.20 mm away"));
  EXPECT_THAT(FirstMessage(file(WipedLong(9, 1001, 0)), file(WipedLong(9, 1001, .2))),
              HasSubstr("more than 1000 moves"));
}

TEST(VerifyWipes, AreComparedWithLongPathsInLinearTime) {
  const auto check = [](int lines) {
    const std::string print = kHead + WipedLong(lines, lines, 0) + kOne;
    EXPECT_EQ(Broken(print, print), "");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(3000, check), traverse::testing::kSlowGrowth);
}

TEST(VerifyWipes, AreNotLost) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  const std::string bare = With(
      two, "G1 E-.5 F2100\n;WIPE_START\nG1 F7200\nG1 X7 Y0 E-.5\n;WIPE_END\n", "G1 E-1 F2100\n");
  EXPECT_EQ(Broken(head + two, head + bare), "wipes");
  EXPECT_EQ(Broken(head + two, head + two), "");
}

// Lines 0.8 mm apart, an open travel as long elsewhere; and the first line the other way round, so
// that its end is where the second one begins.
TEST(VerifyWipes, MayBeLeftOutIfThatIsAllowedWhereNothingIsRetracted) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string open =
      "G1 X0 Y20 F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\n"
      "G1 X9 Y20 E.3\nG1 X9 Y20.8 F9000\nG1 F1800\nG1 X0 Y20.8 E.3\n";
  const std::string original =
      head + Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y.8", "X9 Y.8", "X7 Y.8") + open;
  const std::string wiped =
      head + Wiped("X9 Y0", "X0 Y0", "X2 Y0") + Wiped("X0 Y.8", "X9 Y.8", "X7 Y.8") + open;
  const std::string wipe = "G1 E-.5 F2100\n;WIPE_START\nG1 F7200\nG1 X2 Y0 E-.5\n;WIPE_END\n";
  const std::string prime = "G1 X0 Y.8 F9000\nG1 E1 F2100\n";
  const std::string without = With(With(wiped, wipe, ""), prime, "G1 X0 Y.8 F9000\n");
  VerifyPermissions allowed;
  allowed.wipes = true;
  EXPECT_EQ(Broken(original, wiped, allowed), "");
  EXPECT_EQ(Broken(original, without, allowed), "");
  EXPECT_EQ(Broken(original, without), "wipes");
  EXPECT_EQ(Broken(original, without, Policy::kFree), "wipes");
  EXPECT_EQ(Broken(original, without, Policy::kFast), "");
  EXPECT_EQ(Broken(original, With(wiped, wipe, "G1 E-1 F2100\n"), allowed), "wipes");
}

// Where the slicer retracts behind the marks of the next layer, and does not wipe for that, it
// would not have wiped another path that stands last.
TEST(VerifyWipes, AreLeftOutAtTheEndOfALayerAsTheFileDoes) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const auto bare = [](const std::string& y) {
    return "G1 X0 Y" + y + " F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 X9 Y" + y +
           " E.3\n";
  };
  const std::string to = kNextLayer + "G1 E-1 F2100\n" + bare("20");
  const std::string wiped = Wiped("X0 Y0", "X9 Y0", "X7 Y0");
  const std::string a = head + wiped + bare("9") + to;
  EXPECT_EQ(Broken(a, head + bare("9") + "G1 E-1 F2100\n" + bare("0") + to), "");
  // But not where that layer is left wiping, nor elsewhere.
  const std::string both =
      head + wiped + Wiped("X0 Y9", "X9 Y9", "X7 Y9") + kNextLayer + bare("20");
  EXPECT_EQ(Broken(both, head + Wiped("X0 Y9", "X9 Y9", "X7 Y9") + bare("0") + to), "wipes");
  EXPECT_EQ(Broken(a, head + bare("0") + "G1 E-1 F2100\n" + bare("9") + to), "wipes");
}

// A corner that is wiped along both its sides.
std::string WipedCorner(const std::string& wipe) {
  return absl::StrCat("G1 X0 Y5 F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\n",
                      "G1 X5 Y5 E.3\nG1 X5 Y10 E.3\n;WIPE_START\nG1 F7200\n", wipe, ";WIPE_END\n");
}

// A line that is turned ends where the next one begins: the wipe behind both is of the latter.
TEST(VerifyWipes, BelongToTheLastOfPathsThatMeet) {
  const auto print = [](const std::string& from, const std::string& lines) {
    return kHead + "G1 E-1 F2100\n" + Wiped("X0 Y20", "X9 Y20", "X7 Y20") + "G1 " + from +
           " F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\n" + lines;
  };
  const std::string original =
      print("X9 Y0",
            "G1 X0 Y0 E.3\nG1 X9 Y0 F9000\nG1 F1800\nG1 X9 Y5 E.3\nG1 X8 Y6 F9000\n"
            "G1 F1800\nG1 X0 Y6 E.3\n");
  const auto turned = [&print](const std::string& back) {
    return print("X0 Y0", "G1 X9 Y0 E.3\nG1 X9 Y5 E.3\nG1 E-.5 F2100\n;WIPE_START\nG1 F7200\nG1 " +
                              back +
                              " E-.5\n;WIPE_END\nG1 X0 Y6 F9000\nG1 E1 F2100\nG1 F1800\n"
                              "G1 X8 Y6 E.3\n");
  };
  EXPECT_EQ(Broken(original, turned("X9 Y3")), "");
  EXPECT_EQ(Broken(original, turned("X8.5 Y3")), "wipes");
}

TEST(VerifyWipes, TakeNoShortCut) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string along = WipedCorner("G1 X5 Y5 E-.6\nG1 X1 Y5 E-.4\n");
  const std::string across = WipedCorner("G1 X0 Y5 E-1\n");
  EXPECT_EQ(Broken(head + along, head + along), "");
  EXPECT_EQ(Broken(head + along, head + across), "wipes");
  EXPECT_EQ(Broken(head + across, head + across), "");
}

// Each move lies on the path, and is no shorter than the wipes of the original.
TEST(VerifyWipes, TurnBackOnlyWhereTheirPathDoes) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  const std::string back = With(two, "G1 X7 Y5 E-.5\n", "G1 X7 Y5 E-.25\nG1 X9 Y5 E-.25\n");
  EXPECT_EQ(Broken(head + two, head + back), "wipes");
  EXPECT_EQ(Broken(head + back, head + back), "");
  // Of a path there and back.
  const std::string spike = With(two, "G1 X9 Y5 E.3\n", "G1 X9 Y5 E.3\nG1 X8 Y5 E.1\n");
  const std::string along = With(spike, "G1 X7 Y5 E-.5\n", "G1 X9 Y5 E-.1667\nG1 X7 Y5 E-.3333\n");
  EXPECT_EQ(Broken(head + spike, head + along), "");
}

// A longer wipe may not take on what is pulled at a standstill around it.
TEST(VerifyWipes, PullNoMoreThanThoseOfTheOriginal) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  const std::string more = With(two, "G1 E-.5 F2100\n;WIPE_START\nG1 F7200\nG1 X7 Y5 E-.5\n",
                                "G1 E-.4 F2100\n;WIPE_START\nG1 F7200\nG1 X6 Y5 E-.6\n");
  EXPECT_EQ(Broken(head + two, head + more), "wipes");
}

TEST(VerifyWipes, AreNotShortened) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X9 Y5", "X7 Y5");
  EXPECT_EQ(Broken(head + two, head + With(two, "G1 X7 Y5 E-.5", "G1 X8 Y5 E-.5")), "wipes");
  EXPECT_EQ(Broken(head + two, head + With(two, "G1 X7 Y5 E-.5", "G1 X6.5 Y5 E-.5")), "");
}

// A path that is shorter than a wipe is wiped from end to end, steeper than others.
TEST(VerifyWipes, AreNoSteeperThanThoseThatAreAsLong) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X7 Y0") + Wiped("X0 Y5", "X.5 Y5", "X0 Y5");
  EXPECT_EQ(Broken(head + two, head + With(two, "G1 X7 Y0 E-.5", "G1 X8 Y0 E-.5")), "wipes");
  const std::string turned = Wiped("X9 Y0", "X0 Y0", "X2 Y0") + Wiped("X.5 Y5", "X0 Y5", "X.5 Y5");
  EXPECT_EQ(Broken(head + two, head + turned), "");
}

TEST(VerifyWipes, PullAsEvenlyAsThoseOfTheOriginal) {
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string even = WipedCorner("G1 X5 Y9.8 E-.02\nG1 X5 Y5 E-.48\n");
  const std::string at_once = WipedCorner("G1 X5 Y9.8 E-.5\nG1 X5 Y5 E0\n");
  EXPECT_EQ(Broken(head + even, head + at_once), "wipes");
  EXPECT_EQ(Broken(head + at_once, head + at_once), "");
}

// Towers have marks of wipes around what they print: there is a fault in the original, but another.
TEST(VerifyWipes, MarksAreNoMoreOutOfPlaceThanTheyWere) {
  const std::string odd = kHead + Line("Prime tower", "X0 Y0", "X9 Y0") +
                          "; WIPE_START\nG1 X7 Y0 E.01\n; WIPE_END\nG1 E-1 F2100\n";
  EXPECT_EQ(Broken(odd, odd), "");
  EXPECT_EQ(Broken(odd, With(odd, "; WIPE_START\n", "")), "wipes");
  EXPECT_EQ(Broken(odd, With(odd, "; WIPE_END\n", "; WIPE_START\n")), "wipes");
}

TEST(VerifyWipes, KeepTheirMarks) {
  const std::string a = kHead + Wiped("X0 Y0", "X9 Y0", "X5 Y0") + Wiped("X0 Y5", "X9 Y5", "X5 Y5");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, ";WIPE_START\n", "")), "wipes");
  EXPECT_THAT(Broken(a, With(a, ";WIPE_END\n", "")), HasSubstr("wipes"));
  EXPECT_EQ(Broken(a, With(a, "G1 F1800\n", ";WIPE_START\n;WIPE_END\nG1 F1800\n")), "wipes");
}

// What is printed is no wipe, though nothing of the wipe has been done yet.
TEST(VerifyWipes, MarksBeginBehindWhatIsPrinted) {
  const std::string two = Wiped("X0 Y0", "X9 Y0", "X5 Y0") + Wiped("X0 Y5", "X9 Y5", "X5 Y5");
  const std::string a = kHead + With(two, "G1 X9 Y5 E.3\n", "G1 X8 Y5 E.3\nG1 X9 Y5 E.1\n");
  const std::string early =
      With(With(a, "G1 X9 Y5 E.1\nG1 E-.5 F2100\n;WIPE_START\n", "G1 X9 Y5 E.1\nG1 E-.5 F2100\n"),
           "G1 X9 Y5 E.1\n", ";WIPE_START\nG1 X9 Y5 E.1\n");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, early), "wipes");
  EXPECT_EQ(Broken(early, early), "");
  // A mark of other words is none, but a comment.
  EXPECT_EQ(Broken(a, With(a, ";WIPE_START", ";WIPE_START x")), "same_print");
}

TEST(VerifyWipes, PullAllAlong) {
  const std::string one = "G1 X7 Y5 E-.25\nG1 X5 Y5 E-.25\n";
  const std::string wiped = With(Wiped("X0 Y5", "X9 Y5", "X5 Y5"), "G1 X5 Y5 E-.5\n", one);
  const std::string a = kHead + Wiped("X0 Y0", "X9 Y0", "X5 Y0") + wiped;
  const auto other = [&](const char* lines) { return With(a, one, lines); };
  EXPECT_EQ(Broken(a, other("G1 X5 Y5 E-.5\n")), "");
  EXPECT_EQ(Broken(a, other("G1 X7 Y5 E-.5\nG1 X5 Y5\n")), "wipes");
}

// An arc this short lies near its path even if it turns the other way, or goes round its circle.
TEST(VerifyWipes, ArcsTurnAsTheirPathDoes) {
  const auto wiped = [](const char* back) {
    return absl::StrCat("G1 X0 Y5 F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\n",
                        "G1 X5 Y5 E.3\nG2 X5.04 Y5 I.02 J0 E.01\n;WIPE_START\nG1 F7200\n", back,
                        " E-.1\nG1 X1 Y5 E-.9\n;WIPE_END\n");
  };
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string back = "G3 X5 Y5 I-.02 J0";
  const std::string a = head + wiped(back.c_str());
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, head + wiped("G3 X5 Y5 I-.02 J.0005")), "");
  EXPECT_EQ(Broken(a, head + wiped("G2 X5 Y5 I-.02 J0")), "wipes");
  EXPECT_EQ(Broken(head + wiped("G2 X5 Y5 I-.02 J0"), head + wiped("G2 X5 Y5 I-.02 J0")), "");
}

// Behind a retraction nothing is left to pull back.
TEST(VerifyWipes, WithoutFilamentAreWipesToo) {
  const auto wiped = [](const char* from, const char* to, const char* back) {
    return absl::StrCat("G1 ", from, " F9000\nG1 E1 F2100\n;TYPE:Internal infill\nG1 F1800\nG1 ",
                        to, " E.3\nG1 E-1 F2100\n;WIPE_START\nG1 F7200\nG1 ", back,
                        "\n;WIPE_END\n");
  };
  const std::string head = kHead + "G1 E-1 F2100\n";
  const std::string two = wiped("X0 Y0", "X9 Y0", "X7 Y0") + wiped("X0 Y5", "X9 Y5", "X7 Y5");
  const std::string turned = wiped("X9 Y5", "X0 Y5", "X2 Y5") + wiped("X9 Y0", "X0 Y0", "X2 Y0");
  const std::string beside = wiped("X9 Y5", "X0 Y5", "X2 Y5") + wiped("X9 Y0", "X0 Y0", "X2 Y1");
  EXPECT_EQ(Broken(head + two, head + turned), "");
  EXPECT_EQ(Broken(head + two, head + beside), "wipes");
  const std::string bare =
      With(turned, "G1 E-1 F2100\n;WIPE_START\nG1 F7200\nG1 X2 Y5\n;WIPE_END\n", "G1 E-1 F2100\n");
  EXPECT_EQ(Broken(head + two, head + bare), "wipes");
}

// Where the head has come down beside what is finished, some files wipe once more.
TEST(VerifyWipes, AsideAreThoseOfTheOriginal) {
  const std::string one = Wiped("X0 Y0", "X10 Y0", "X7 Y0");
  const std::string other = Wiped("X0 Y10", "X10 Y10", "X7 Y10");
  const std::string aside =
      "G1 Z1 F9000\nG1 X60 Y30 F9000\nG1 Z.2\nG1 E1 F2100\nG1 E-.5 F2100\n;WIPE_START\nG1 F7200\n"
      "G1 X60 Y32 E-.5\n;WIPE_END\n";
  const std::string next = aside + Wiped("X80 Y0", "X90 Y0", "X87 Y0");
  const std::string begin = kHead + "G1 E-1 F2100\n";
  constexpr uint32_t kWipesAlone = RuleBit(VerifyRule::kWipes);

  EXPECT_EQ(Broken(begin + one + other + next, begin + other + one + next, {}, kWipesAlone), "");
  EXPECT_EQ(Broken(begin + one + other + next, begin + other + one + With(next, "Y32", "Y25"), {},
                   kWipesAlone),
            "wipes");
}

}  // namespace
}  // namespace traverse::gcode
