// What a good file may have wrong though each of its lines looks as it should.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

// Two lines of infill far from each other.
const std::string kOne = Line("Internal infill", "X0 Y0", "X9 Y0");
const std::string kOther = Line("Internal infill", "X0 Y5", "X9 Y5");
const std::string kTwo = kOne + kOther;

// --- lines
// -----------------------------------------------------------------------------------------

TEST(VerifyRules, LinesEndAsTheyDidAndACarriageReturnEndsOne) {
  const std::string a = kHead + kTwo;
  const std::string crlf = absl::StrReplaceAll(a, {{"\n", "\r\n"}});
  const std::string mixed = With(a, "M83\n", "M83\r\n");
  EXPECT_EQ(Broken(a, mixed), "same_print");
  EXPECT_EQ(Broken(crlf, With(crlf, "M83\r\n", "M83\n")), "same_print");
  EXPECT_EQ(Broken(mixed, mixed), "");
  // Whoever carries files about may change all of them.
  EXPECT_EQ(Broken(a, crlf), "");
  EXPECT_EQ(Broken(crlf, a), "");

  // To firmware there is a command behind it.
  EXPECT_EQ(Broken(a, With(a, "X9 Y5 E.3\n", "X9 Y5 E.3 ; x\rM106 S3\n")), "same_print");
  const std::string both = With(a, "M83\n", "M83 ; x\rM106 S3\n");
  EXPECT_EQ(Broken(both, both), "");
}

TEST(VerifyRules, CommentsBetweenPathsThatStayKeepTheirOrder) {
  const std::string a = kHead + "; here\n" + kOne + "; there\n" + kOther;
  EXPECT_EQ(Broken(a, kHead + "; there\n" + kOne + "; here\n" + kOther), "same_print");
  EXPECT_EQ(Broken(a, kHead + "; there\n" + kOther + "; here\n" + kOne), "");
}

TEST(VerifyRules, TheHeadLeavesThePrintThoughNoScriptFollows) {
  const std::string end = "G1 E-1 F2100\nG1 Z10 F9000\n";
  const std::string a = kHead + kTwo + end;
  EXPECT_EQ(Broken(a, kHead + kTwo), "same_print");
  EXPECT_EQ(Broken(a, kHead + kTwo + "G1 Z10 F9000\n"), "same_print");
  EXPECT_EQ(Broken(a, kHead + kTwo + "G1 E-1 F2100\n"), "same_print");
  EXPECT_EQ(Broken(a, kHead + kOther + kOne + end), "");
}

TEST(VerifyRules, TravelMayBeByG0) {
  const std::string script = "G28\nM83\nG1 X5 Y5 F9000\n;LAYER_CHANGE\nG1 Z.2 F9000\n";
  EXPECT_EQ(Broken(script + kTwo, With(script, "G1 X5", "G0 X5") + kTwo), "");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X0 Y5", "G0 X0 Y5")), "");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X9 Y5", "G0 X9 Y5")), "same_print");
}

TEST(VerifyRules, LinesBehindASlashMayBeDoneOrNot) {
  const std::string head = "M82\n;LAYER_CHANGE\nG1 Z.2 F9000\nG92 E1\n/G92 E0\n";
  const std::string a = head + "G1 X0 Y0\nG1 X5 Y0 E2 F1200\nG1 X0 Y5 F9000\nG1 X5 Y5 E4 F1200\n";
  const std::string b = head + "G1 X0 Y5\nG1 X5 Y5 E3 F1200\nG1 X0 Y0 F9000\nG1 X5 Y0 E4 F1200\n";
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, b), "same_print");
  EXPECT_EQ(Broken(With(a, "/G92 E0", "/M7"), With(b, "/G92 E0", "/M7")), "");
}

TEST(VerifyRules, TheMarkOfUtf8StaysInFrontOfTheFile) {
  const std::string a = "; generated\n" + kHead + kTwo;
  EXPECT_EQ(Broken(a, "\xEF\xBB\xBF" + a), "same_print");
  const std::string marked = "\xEF\xBB\xBF" + a;
  EXPECT_EQ(Broken(marked, "; optimised by Traverse 1.0: x\n" + marked), "same_print");
  EXPECT_EQ(Broken(marked, With(marked, "ted\n", "ted\n; optimised by Traverse 1.0: x\n")), "");
}

TEST(VerifyRules, TheLineOfTheWriterIsInTheHeadAndNotInAPicture) {
  const std::string says = "; optimised by Traverse 1.0, policy safe: x\n";
  const std::string picture = "; thumbnail begin 16x16 8\n; abcd\n; thumbnail end\n";
  const std::string a = picture + kHead + kTwo;
  EXPECT_EQ(Broken(a, picture + says + kHead + kTwo), "");
  EXPECT_EQ(Broken(a, says + a), "");
  EXPECT_EQ(Broken(a, With(a, "; abcd\n", says + "; abcd\n")), "same_print");
  EXPECT_EQ(Broken(a, picture + kHead + kOne + says + kOther), "same_print");
}

TEST(VerifyRules, CommentsThatAreAboutNoPathKeepTheirOrder) {
  const std::string settings = "M104 S0\n; a = 1\n; b = 2\n";
  const std::string turned = "M104 S0\n; b = 2\n; a = 1\n";
  EXPECT_EQ(Broken(kHead + kTwo + settings, kHead + kTwo + turned), "same_print");
  const std::string picture = "; thumbnail begin 16x16 8\n; abcd\n; efgh\n; thumbnail end\n";
  const std::string spoilt = "; thumbnail begin 16x16 8\n; efgh\n; abcd\n; thumbnail end\n";
  EXPECT_EQ(Broken(picture + kHead + kTwo, spoilt + kHead + kTwo), "same_print");
}

TEST(VerifyRules, WhatIsSaidOfALayerStandsBehindItsMark) {
  const std::string mark = ";LAYER_CHANGE\n;Z:.2\n;HEIGHT:.2\n";
  const std::string layer = "G1 Z.2 F9000\n" + kTwo;
  const std::string a =
      "M83\n" + mark + layer + ";LAYER_CHANGE\n;Z:.4\n;HEIGHT:.2\nG1 Z.4\n" + kTwo;
  EXPECT_EQ(Broken(a, a), "");
  // It is .2 all the same.
  EXPECT_EQ(Broken(a, With(a, ";Z:.4\n;HEIGHT:.2\n", ";Z:.4\n")), "same_print");
  EXPECT_EQ(Broken(a, With(With(a, ";Z:.4\n", ""), "G1 Z.4\n", "G1 Z.4\n;Z:.4\n")), "same_print");
  EXPECT_EQ(Broken(a, With(a, kOther, ";HEIGHT:.2\n" + kOther)), "");
}

TEST(VerifyRules, WhatStandsBehindADepositStaysThere) {
  const std::string a = kHead + With(kTwo, "X9 Y5 E.3\n", "X9 Y5 E.3 ; infill\n");
  EXPECT_EQ(Broken(a, With(a, " ; infill", "")), "same_print");
  EXPECT_EQ(Broken(a, With(a, "; infill", "; bridge")), "same_print");
  EXPECT_EQ(Broken(a, With(a, " ; infill", ";infill")), "");
}

TEST(VerifyRules, DepositsAreOfTheSameCommand) {
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X9 Y5 E.3", "G0 X9 Y5 E.3")), "same_print");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X0 Y5 F9000", "G0 X0 Y5 F9000")), "");
  const std::string arc = With(kTwo, "G1 X9 Y5 E.3", "G2 X9 Y5 I4.5 J0 E.3");
  EXPECT_EQ(Broken(kHead + arc, kHead + With(arc, "J0 E.3", "J0 P2 E.3")), "same_print");
}

// The center of an arc by its radius is nowhere known: it stays as it is.
TEST(VerifyRules, ArcsByARadiusKeepIt) {
  const std::string way = "G1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E1 F2100\n";
  const std::string a = kHead + With(kTwo, way, "G1 E-1 F2100\nG2 X0 Y5 R8 F9000\nG1 E1 F2100\n");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, "R8", "R1000000")), "same_print");
}

TEST(VerifyRules, SettingsAreAsTheyWereWhereALineIsNotKnown) {
  const std::string set = "M204 S500\n" + kTwo + "M104 S0\nM84\n";
  EXPECT_EQ(Broken(kHead + set, kHead + With(set, "M104 S0\n", "M204 S9\nM104 S0\n")),
            "same_print");
  EXPECT_EQ(Broken(kHead + set, kHead + With(set, "M104 S0\n", "M204 S500\nM104 S0\n")), "");
  EXPECT_EQ(Broken(kHead + set, kHead + With(set, "M84\n", "M84\nM221 S90\n")), "same_print");
}

TEST(VerifyRules, FilamentIsPulledBackOnTheSameSideOfALabel) {
  const std::string way = Way("X0 Y5");
  const std::string inside =
      "G1 E-1 F2100\n; stop printing object a\n" + With(way, "G1 E-1 F2100\n", "");
  const std::string outside = "; stop printing object a\n" + way;
  const std::string a = kHead + With(kTwo, way, inside);
  const std::string b = kHead + With(kTwo, way, outside);
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, b), "retractions");
  EXPECT_EQ(Broken(b, a), "retractions");
}

// --- order
// -----------------------------------------------------------------------------------------

TEST(VerifyRules, OrderNothingPassesAChangeOfTheFanUnderSafeAndBalanced) {
  const auto under = [](const char* fan, const std::string& path) {
    return absl::StrCat(fan, path);
  };
  const std::string a = under("M106 S9\n", kOne) + under("M106 S99\n", kOther) + "M106 S99\n";
  const std::string b = under("M106 S99\n", kOther) + under("M106 S9\n", kOne) + "M106 S99\n";
  EXPECT_EQ(Broken(kHead + a, kHead + b), "order");
  EXPECT_EQ(Broken(kHead + a, kHead + b, Policy::kBalanced), "order");
  EXPECT_EQ(Broken(kHead + a, kHead + b, Policy::kFree), "");
  VerifyPermissions allowed;
  allowed.fan_order = true;
  EXPECT_EQ(Broken(kHead + a, kHead + b, allowed), "");
  const std::string same = "M106 S9\n" + kTwo;
  EXPECT_EQ(Broken(kHead + same, kHead + "M106 S9\n" + kOther + kOne), "");
}

// --- ways
// ------------------------------------------------------------------------------------------

TEST(VerifyRules, LiftsTheHeadDoesNotGoDownIntoWhatIsPrinted) {
  const std::string dips =
      With(kTwo, "G1 X0 Y5 F9000\n", "G1 X0 Y5 F9000\nG1 Z.05\nG1 Z.2 F9000\n");
  EXPECT_THAT(Broken(kHead + kTwo, kHead + dips), HasSubstr("lifts"));
  EXPECT_EQ(Broken(kHead + dips, kHead + dips), "");
}

TEST(VerifyRules, LiftsAreDoneOnce) {
  const std::string twice =
      With(kLifted, "G1 Z.6 F9000\nG1 X10 Y30", "G1 Z.6 F9000\nG1 Z.2\nG1 Z.6\nG1 X10 Y30");
  EXPECT_EQ(Broken(kHead + kLifted, kHead + twice), "lifts");
  EXPECT_EQ(Broken(kHead + twice, kHead + twice), "");
}

TEST(VerifyRules, LiftsOfASpiralGoRoundTheSameCircle) {
  const auto spiral = [](const char* x, const char* i) {
    return absl::StrCat("G1 E-1 F2100\nG17\nG3 Z.6 I", i, " J0 F9000\nG1 X", x,
                        " Y9 F9000\nG1 Z.2\nG1 E1 F2100\nG1 F1800\nG1 X", x, " Y20 E.3\n");
  };
  const std::string a = kHead + spiral("1", "1.2") + spiral("5", "1.2") + spiral("9", "1.2");
  const std::string moved = kHead + spiral("1", "1.2") + spiral("9", "1.2") + spiral("5", "1.2");
  EXPECT_EQ(Broken(a, moved), "");
  EXPECT_EQ(Broken(a, kHead + spiral("1", "1.2") + spiral("5", "9") + spiral("9", "1.2")), "lifts");
}

TEST(VerifyRules, RetractionsAreDoneBeforeTheWayAndUndoneBehindIt) {
  const std::string pushed_halfway =
      "G1 E-1 F2100\nG1 X4.5 Y2.5 F9000\nG1 E.5 F2100\nG1 X0 Y5 F9000\nG1 E.5 F2100\n";
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, Way("X0 Y5"), pushed_halfway)), "retractions");
  const std::string pulled_halfway = "G1 X4 Y2 F9000\nG1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E1 F2100\n";
  EXPECT_THAT(Broken(kHead + kTwo, kHead + With(kTwo, Way("X0 Y5"), pulled_halfway)),
              HasSubstr("retractions"));
  const std::string half_pulled =
      "G1 E-.5 F2100\nG1 X4.5 Y2.5 F9000\nG1 E-.5 F2100\nG1 X0 Y5 F9000\nG1 E1 F2100\n";
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, Way("X0 Y5"), half_pulled)), "retractions");
  EXPECT_EQ(Broken(kHead + With(kTwo, Way("X0 Y5"), half_pulled),
                   kHead + With(kTwo, Way("X0 Y5"), half_pulled)),
            "");
}

TEST(VerifyRules, RetractionsAreForAWay) {
  const std::string idle = Way("X0 Y5") + "G1 E-1 F2100\nG1 E1 F2100\n";
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, Way("X0 Y5"), idle)), "retractions");
}

TEST(VerifyRules, OpenWaysAreNoLongerThanTheLongestWhateverTheyCross) {
  const std::string far = Line("Internal infill", "X80 Y5", "X89 Y5");
  const std::string near = kOne + "G1 X9 Y2 F9000\nG1 F1800\nG1 X0 Y2 E.3\n";
  const std::string open = With(far, Way("X80 Y5"), "G1 X80 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + near + far, kHead + near + open), "open_ways");
  EXPECT_EQ(Broken(kHead + near + open, kHead + near + open), "");
}

TEST(VerifyRules, OpenWaysLeadToALayerWhereSuchDo) {
  const std::string next = ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  const std::string a = kHead + kOne + "G1 X9 Y3 F9000\nG1 F1800\nG1 X0 Y3 E.3\n" + next;
  const std::string open = With(kOther, Way("X0 Y5"), "G1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(a + kOther, a + open), "open_ways");
  EXPECT_EQ(Broken(a + open, a + kOther), "");
}

TEST(VerifyRules, BoundsAWayWindsNoMoreThanWaysDo) {
  const std::string frame = Line("Internal infill", "X60 Y60", "X50 Y60");
  const std::string astray = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X40 Y50 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo + frame, kHead + astray + frame), "bounds");
  const std::string back = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X0 Y5 F9000\nG1 X9 Y0\nG1 X0 Y5\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + back), "bounds");
  const std::string in_two = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X5 Y2 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo + frame, kHead + in_two + frame), "");
}

TEST(VerifyRules, WipesKeepTheirMarks) {
  const std::string a = kHead + Wiped("X0 Y0", "X9 Y0", "X5 Y0") + Wiped("X0 Y5", "X9 Y5", "X5 Y5");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, ";WIPE_START\n", "")), "wipes");
  EXPECT_THAT(Broken(a, With(a, ";WIPE_END\n", "")), HasSubstr("wipes"));
  EXPECT_EQ(Broken(a, With(a, "G1 F1800\n", ";WIPE_START\n;WIPE_END\nG1 F1800\n")), "wipes");
}

TEST(VerifyRules, WipesPullAllAlong) {
  const std::string one = "G1 X7 Y5 E-.25\nG1 X5 Y5 E-.25\n";
  const std::string wiped = With(Wiped("X0 Y5", "X9 Y5", "X5 Y5"), "G1 X5 Y5 E-.5\n", one);
  const std::string a = kHead + Wiped("X0 Y0", "X9 Y0", "X5 Y0") + wiped;
  const auto other = [&](const char* lines) { return With(a, one, lines); };
  EXPECT_EQ(Broken(a, other("G1 X5 Y5 E-.5\n")), "");
  EXPECT_EQ(Broken(a, other("G1 X7 Y5 E-.5\nG1 X5 Y5\n")), "wipes");
}

}  // namespace
}  // namespace traverse::gcode
