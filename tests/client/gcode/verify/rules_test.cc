// What all rules have in common, and lines that machines may leave out:
// client/gcode/verify/verifier.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::StartsWith;

TEST(VerifyRules, NamesRuleFileAndBothLines) {
  EXPECT_EQ(FirstMessage(kHead + kSquare, kHead + kSquareTurned),
            "b:9: this outer wall is printed in the opposite direction (direction; a:9)");
}

// Broken asserts that each break of every test names both.
TEST(VerifyRules, NamesThePathThatLeadsOnWhereTheOtherFileHasNoSuchLine) {
  // Filament that only one of the files pushes, before the second line of infill.
  const std::string bare = kHead + kOne + "G1 X9 Y2 F9000\nG1 F1800\nG1 X0 Y2 E.3\n";
  const std::string pushed = With(bare, "Y2 F9000\n", "Y2 F9000\nG1 E.2 F2100\n");
  EXPECT_THAT(FirstMessage(bare, pushed), StartsWith("b:11: pushes"));
  EXPECT_THAT(FirstMessage(bare, pushed), EndsWith("(standstill; a:12)"));
  EXPECT_THAT(FirstMessage(pushed, bare), StartsWith("b:12: the original pushes"));
  EXPECT_THAT(FirstMessage(pushed, bare), EndsWith("(standstill; a:11)"));
  // A line end, and lines behind the end of the other file.
  EXPECT_THAT(FirstMessage(kHead + kTwo, kHead + With(kTwo, "X0 Y5 F9000\n", "X0 Y5 F9000\r\n")),
              AllOf(StartsWith("b:11: "), EndsWith("(same_print; a:15)")));
  EXPECT_EQ(FirstMessage(kHead + kTwo, kHead + kTwo + "M84\n"),
            "b:16: a different line from the one at a:15");
}

// Whichever rule: what a slicer does itself is never refused.
TEST(VerifyRules, AFileIsEquivalentToItself) {
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    for (const std::string& text : {kSquare, kAcross, kLifted, kZigzag}) {
      EXPECT_EQ(Broken(kHead + text, kHead + text, policy), "");
    }
  }
}

TEST(VerifyRules, TellTheLayerOfABreak) {
  const std::string next = ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  const VerifyReport report = CheckGcode(kHead + kZigzag + next + kSquare, "a",
                                         kHead + kZigzag + next + kSquareTurned, "b");
  ASSERT_EQ(report.breaks.size(), 1u);
  EXPECT_EQ(report.breaks[0].layer, 1);
  EXPECT_EQ(report.breaks[0].rule, VerifyRule::kDirection);
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

}  // namespace
}  // namespace traverse::gcode
