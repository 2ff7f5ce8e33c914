// Sections line by line: client/gcode/verify/same_print.

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/files/md5.h"
#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

TEST(SamePrint, LinesEndAsTheyDidAndACarriageReturnEndsOne) {
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

// Where the register stands is another place in another order; what it counts on is the same.
TEST(SamePrint, FilamentIsTheSameWhereverTheRegisterStands) {
  const auto print = [](const char* first, const char* second) {
    return absl::StrCat("M82\nG92 E0\nG1 Z.2 F9000\n", first, second);
  };
  const std::string a =
      print("G1 X0 Y5 F9000\nG1 X9 Y5 F1200 E.3333333333333333\n",
            "G1 X0 Y7 F9000\nG1 X9 Y7 F1200 E.6666666666666666\nG1 X0 Y7 E1.1234564999\n");
  const std::string b = print("G1 X0 Y7 F9000\nG1 X9 Y7 F1200 E.333333333\nG1 X0 Y7 E.790123166\n",
                              "G1 X0 Y5 F9000\nG1 X9 Y5 F1200 E1.123456499\n");
  EXPECT_EQ(Broken(a, b), "");
  EXPECT_EQ(Broken(a, With(b, "E.790123166", "E.790125")), "same_print");
}

TEST(SamePrint, CommentsBetweenPathsThatStayKeepTheirOrder) {
  const std::string a = kHead + "; here\n" + kOne + "; there\n" + kOther;
  EXPECT_EQ(Broken(a, kHead + "; there\n" + kOne + "; here\n" + kOther), "same_print");
  EXPECT_EQ(Broken(a, kHead + "; there\n" + kOther + "; here\n" + kOne), "");
}

// Whatever it says, it belongs to what is printed behind it.
TEST(SamePrint, CommandsThatChangeNothingStandWhereCommentsMay) {
  for (const char* line : {"M117 here\n", "M300 S440 P100\n", "G90\n", "M83\n", "M140 S60\n",
                           "M104 S215\n", "SET_DISPLAY_TEXT MSG=here\n"}) {
    const std::string head = kHead + "M104 S215\nM140 S60\n" + kSquare;
    const std::string a = head + line + kOne + kOther;
    EXPECT_EQ(Broken(a, head + kOther + line + kOne), "") << line;
    EXPECT_EQ(Broken(a, head + kOne + line + kOther), "same_print")
        << "of the other path: " << line;
    EXPECT_EQ(Broken(a, head + kOne + kOther), "same_print") << line;
  }
}

// A comment goes with its path, and a question of the host stays with the retraction.
TEST(SamePrint, CommandsThatSaySomethingAndCommentsPassEachOtherBetweenPaths) {
  const auto print = [](const std::string& said) { return kHead + kOne + said + kOther; };
  const std::string both = print("; here\nM105\nM117 here\n");
  EXPECT_EQ(Broken(both, print("M105\n; here\nM117 here\n")), "");
  EXPECT_EQ(Broken(both, print("; here\nM117 here\nM105\n")), "same_print");
  EXPECT_EQ(Broken(both, kHead + "; here\n" + kOne + "M105\nM117 here\n" + kOther), "same_print");
  EXPECT_EQ(Broken(both, kHead + "M105\n" + kOne + "; here\nM117 here\n" + kOther), "same_print");
}

TEST(SamePrint, PicturesAreTakenWithTheFilamentPulledBackAsItWas) {
  const std::string print =
      kHead + kOne + "G1 E-.8 F2100\nTIMELAPSE_TAKE_FRAME\nG1 E.8 F2100\n" + kOther;
  EXPECT_EQ(Broken(print, print), "");
  EXPECT_EQ(Broken(print, With(print, "G1 E-.8 F2100\nTIMELAPSE_TAKE_FRAME\n",
                               "TIMELAPSE_TAKE_FRAME\nG1 E-.8 F2100\n")),
            "same_print");
}

TEST(SamePrint, CommandsThatMayChangeSomethingStay) {
  for (const char* line : {"M104 S200\n", "M104 S215 T1\n", "M118 here\n", "M155 S1\n"}) {
    const std::string head = kHead + "M104 S215\n" + kSquare;
    EXPECT_EQ(Broken(head + line + kOne + kOther, head + kOther + line + kOne), "same_print")
        << line;
  }
  // A script may be what states it.
  const std::string first = "G1 Z9 F9000\n";
  EXPECT_EQ(Broken("G90\n" + first + kHead + kOne, first + "G90\n" + kHead + kOne), "same_print");
}

// `; stop printing` may be a line that a plugin of the printer looks for.
TEST(SamePrint, CommentsStayBetweenThePathsBetweenWhichTheyStand) {
  const std::string a = kHead + kOne + "; stop printing\n" + kOther;
  EXPECT_EQ(Broken(a, kHead + "; stop printing\n" + kOne + kOther), "same_print");
  EXPECT_EQ(Broken(a, kHead + kOne + kOther + "; stop printing\n"), "same_print");
  EXPECT_EQ(Broken(a, kHead + kOther + "; stop printing\n" + kOne), "");
}

TEST(SamePrint, ScarfSeamsDoNotDivideALayer) {
  const std::string scarf =
      "G1 X10 Y40 Z.1 F9000\n;TYPE:Outer wall\nG1 F1200\nG1 X15 Y40 Z.15 E.1\nG1 X20 Y40 Z.2 E.2\n"
      "G1 X20 Y50 E.4\n";
  const std::string one = Line("Sparse infill", "X40 Y10", "X50 Y10");
  const std::string other = Line("Sparse infill", "X40 Y20", "X50 Y20");
  const uint32_t same = RuleBit(VerifyRule::kSamePrint);
  for (const std::string& first : {std::string(), kSquare}) {
    const std::string was = kHead + first + scarf + one + other;

    EXPECT_EQ(Broken(was, kHead + first + scarf + other + one, {}, same), "") << first;
    EXPECT_EQ(Broken(was, With(was, "Z.15 E.1", "Z.16 E.1"), {}, same), "same_print") << first;
  }
  // Turned round it would sink.
  const std::string turned =
      "G1 X20 Y50 F9000\n;TYPE:Outer wall\nG1 F1200\nG1 X20 Y40 E.4\nG1 X15 Y40 Z.15 E.2\n"
      "G1 X10 Y40 Z.1 E.1\nG1 Z.2\n";
  EXPECT_EQ(Broken(kHead + kSquare + scarf + one, kHead + kSquare + turned + one, {}, same),
            "same_print");
}

TEST(SamePrint, EachLayerThatIsAnotherIsNamed) {
  const std::string above = "G1 Z.4 F9000\n" + kTwo;
  const std::string a = kHead + kTwo + above + "G1 Z.6 F9000\n" + kTwo;
  const std::string b =
      kHead + With(kTwo, "E.3", "E.4") + above + "G1 Z.6 F9000\n" + With(kTwo, "E.3", "E.2");

  const VerifyReport report = CheckGcode(a, "a", b, "b", {});

  ASSERT_EQ(report.breaks.size(), 2u);
  EXPECT_LT(report.breaks[0].optimised_line + 5, report.breaks[1].optimised_line);
}

// That a line stands in one of the files alone is said once, not of all layers behind it.
TEST(SamePrint, WhatComesBehindALineOfItsOwnIsNotNamed) {
  const std::string above = "G1 Z.4 F9000\n" + kTwo;
  const std::string a = kHead + kTwo + "M104 S200\n" + above + "M104 S210\n" + above;
  const std::string b = kHead + kTwo + above + "M104 S210\n" + above;

  EXPECT_EQ(CheckGcode(a, "a", b, "b", {}).breaks.size(), 1u);
}

TEST(SamePrint, TheHeadLeavesThePrintThoughNoScriptFollows) {
  const std::string end = "G1 E-1 F2100\nG1 Z10 F9000\n";
  const std::string a = kHead + kTwo + end;
  EXPECT_EQ(Broken(a, kHead + kTwo), "same_print");
  EXPECT_EQ(Broken(a, kHead + kTwo + "G1 Z10 F9000\n"), "same_print");
  EXPECT_EQ(Broken(a, kHead + kTwo + "G1 E-1 F2100\n"), "same_print");
  EXPECT_EQ(Broken(a, kHead + kOther + kOne + end), "");
}

// Printers look at it before they print, so it is right in both files or the same in both.
TEST(SamePrint, AFirstLineMayStateTheDigestOfItsFile) {
  const auto with_md5 = [](const std::string& text) {
    return "; MD5:" + Md5Hex(text) + "\n" + text;
  };
  const std::string a = kHead + kTwo;
  const std::string b = kHead + kOther + kOne;
  const std::string right = with_md5(a);
  EXPECT_EQ(Broken(right, with_md5(b)), "");
  EXPECT_EQ(Broken(right, right.substr(0, 39) + b), "same_print");
  EXPECT_EQ(Broken(right, b), "same_print");
  EXPECT_EQ(Broken(a, with_md5(b)), "same_print");
  const std::string wrong = right.substr(0, 39) + With(a, "M83\n", "M83 ; x\n");
  EXPECT_EQ(Broken(wrong, wrong), "");
  EXPECT_EQ(Broken(wrong, with_md5(wrong.substr(39))), "same_print");
  EXPECT_EQ(Broken(right, with_md5(kHead + kOne)), "same_print");
}

// The digest is that of the file as it lies on the disk, so with the numbers of its lines, and with
// a slash before lines that a machine may skip.
TEST(SamePrint, AFirstLineMayStateTheDigestOfNumberedAndOfOptionalLines) {
  const auto with_md5 = [](const std::string& text) {
    return "; MD5:" + Md5Hex(text) + "\n" + text;
  };
  const auto numbered = [](const std::string& text) {
    std::string out;
    int number = 0;
    for (const auto line : absl::StrSplit(text, '\n', absl::SkipEmpty())) {
      if (line[0] != ';') absl::StrAppend(&out, "N", ++number, " ");
      absl::StrAppend(&out, line, "\n");
    }
    return out;
  };
  const std::string slash = "/M117 x\n";
  for (const auto& [a, b] : {std::pair(numbered(kHead + kTwo), numbered(kHead + kOther + kOne)),
                             std::pair(slash + kHead + kTwo, slash + kHead + kOther + kOne)}) {
    const std::string right = with_md5(a);
    EXPECT_EQ(Broken(right, with_md5(b)), "");
    EXPECT_EQ(Broken(right, right.substr(0, 39) + b), "same_print");
  }
}

TEST(SamePrint, TravelMayBeByG0) {
  const std::string script = "G28\nM83\nG1 X5 Y5 F9000\n;LAYER_CHANGE\nG1 Z.2 F9000\n";
  EXPECT_EQ(Broken(script + kTwo, With(script, "G1 X5", "G0 X5") + kTwo), "");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X0 Y5", "G0 X0 Y5")), "");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X9 Y5", "G0 X9 Y5")), "same_print");
}

TEST(SamePrint, CommentsThatAreAboutNoPathKeepTheirOrder) {
  const std::string settings = "M104 S0\n; a = 1\n; b = 2\n";
  const std::string turned = "M104 S0\n; b = 2\n; a = 1\n";
  EXPECT_EQ(Broken(kHead + kTwo + settings, kHead + kTwo + turned), "same_print");
  const std::string picture = "; thumbnail begin 16x16 8\n; abcd\n; efgh\n; thumbnail end\n";
  const std::string spoilt = "; thumbnail begin 16x16 8\n; efgh\n; abcd\n; thumbnail end\n";
  EXPECT_EQ(Broken(picture + kHead + kTwo, spoilt + kHead + kTwo), "same_print");
}

TEST(SamePrint, CommentsOfScriptsStay) {
  const std::string start = "; start\nG28\n;TYPE:Custom\nM83\n; end\n";
  const std::string end = "M104 S0\n;TYPE:Custom\nG1 Z10 F9000\nM84\n";
  const std::string a = start + ";LAYER_CHANGE\nG1 Z.2 F9000\n" + kTwo + end;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, "; start\n", "; start\n;TYPE:x\n")), "same_print");
  EXPECT_EQ(Broken(a, With(a, "G28\n;TYPE:Custom\n", "G28\n")), "same_print");
  EXPECT_EQ(Broken(a, With(a, "S0\n;TYPE:Custom\n", "S0\n")), "same_print");
}

TEST(SamePrint, WhatIsSaidOfALayerStandsBehindItsMark) {
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

// The head is there already: what is said of the first path stands right behind the layer's own.
TEST(SamePrint, WhatIsSaidOfAPathIsNotOfTheLayerWhereNoTravelLeadsToIt) {
  const std::string type = "G1 E-.8 F2100\nG1 E.8\n;TYPE:Internal infill\n;HEIGHT:.2\n";
  const std::string line = "G1 X9 Y9 E.3 F1200\n";
  const std::string a = "M83\n;LAYER_CHANGE\n;Z:.2\n;HEIGHT:.2\nG1 Z.2 F9000\n" + kTwo +
                        ";LAYER_CHANGE\n;Z:.4\n;HEIGHT:.2\nG1 Z.4 F9000\n" + type + line;
  const std::string at_once = With(a, type, "G1 E-.8 F2100\nG1 E.8\n;TYPE:Internal infill\n");
  const std::string open = With(a, type, ";TYPE:Internal infill\n;HEIGHT:.2\n");
  EXPECT_EQ(Broken(a, at_once), "");
  EXPECT_EQ(Broken(open, With(a, type, ";TYPE:Internal infill\n")), "");
  EXPECT_EQ(Broken(a, With(a, ";Z:.4\n", "")), "same_print");
}

TEST(SamePrint, WhatStandsBehindADepositStaysThere) {
  const std::string a = kHead + With(kTwo, "X9 Y5 E.3\n", "X9 Y5 E.3 ; infill\n");
  EXPECT_EQ(Broken(a, With(a, " ; infill", "")), "same_print");
  EXPECT_EQ(Broken(a, With(a, "; infill", "; bridge")), "same_print");
  EXPECT_EQ(Broken(a, With(a, " ; infill", ";infill")), "");
}

TEST(SamePrint, DepositsAreOfTheSameCommand) {
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X9 Y5 E.3", "G0 X9 Y5 E.3")), "same_print");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, "G1 X0 Y5 F9000", "G0 X0 Y5 F9000")), "");
  const std::string arc = With(kTwo, "G1 X9 Y5 E.3", "G2 X9 Y5 I4.5 J0 E.3");
  EXPECT_EQ(Broken(kHead + arc, kHead + With(arc, "J0 E.3", "J0 P2 E.3")), "same_print");
}

// The center of an arc by its radius is nowhere known: it stays as it is.
TEST(SamePrint, ArcsByARadiusKeepIt) {
  const std::string travel = "G1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E1 F2100\n";
  const std::string a =
      kHead + With(kTwo, travel, "G1 E-1 F2100\nG2 X0 Y5 R8 F9000\nG1 E1 F2100\n");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, "R8", "R1000000")), "same_print");
}

TEST(SamePrint, SettingsAreAsTheyWereWhereALineIsNotKnown) {
  const std::string set = "M204 S500\n" + kTwo + "M104 S0\nM84\n";
  EXPECT_EQ(Broken(kHead + set, kHead + With(set, "M104 S0\n", "M204 S9\nM104 S0\n")),
            "same_print");
  EXPECT_EQ(Broken(kHead + set, kHead + With(set, "M104 S0\n", "M204 S500\nM104 S0\n")), "");
  EXPECT_EQ(Broken(kHead + set, kHead + With(set, "M84\n", "M84\nM221 S90\n")), "same_print");
}

// Both files were read from their beginning for each section that differs.
TEST(SamePrint, ManySectionsThatDifferTakeNoLongerEach) {
  const auto check = [](int sections) {
    std::string a = kHead;
    std::string b = kHead;
    for (int i = 0; i < sections; ++i) {
      absl::StrAppend(&a, "G1 X0 Y5 F9000\nG1 X9 Y5 E.3 F1200\nDO_IT\n");
      absl::StrAppend(&b, "G1 X0 Y5 F9000\nG1 X8 Y5 E.3 F1200\nG1 X9 Y5 F9000\nDO_IT\n");
    }
    EXPECT_EQ(Broken(a, b), "same_print");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(500, check), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
