// What the rules of client/gcode/verify/rules have in common, and the rules that need a test or
// two. Of each rule a file that breaks it, and one beside it that does not; the others are in
// rules/.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(VerifyRules, ThePolicyIsThatOfTheFlagsOrOfTheLineAtTheHead) {
  const std::string a = kHead + kSquare;
  const std::string b = kHead + kSquareElsewhere;
  const std::string says = "; optimised by Traverse 1.0, policy balanced: travel\n";

  EXPECT_EQ(FirstMessage(a, says + b), "");
  EXPECT_THAT(FirstMessage(a, b), HasSubstr("seam"));
  EXPECT_EQ(Broken(a, says + b, Policy::kSafe), "seam");
  EXPECT_EQ(Broken(a, b, Policy::kFree), "");
  // Behind a command it is not at the head.
  EXPECT_THAT(FirstMessage(a, With(b, "M83\n", "M83\n" + says)), HasSubstr("seam"));
}

TEST(VerifyRules, WhatIsAllowedIsReadFromTheLineToo) {
  const auto head = PermissionsInHead(
      ";FLAVOR:Marlin\n; optimised by Traverse 1.0, policy safe, allow wall_order+fan_order: x\n");
  ASSERT_TRUE(head.has_value());
  EXPECT_EQ(DescribePermissions(*head), "safe, wall_order, fan_order");
  EXPECT_FALSE(PermissionsInHead("; optimised by Traverse 1.0: x\n").has_value());
  EXPECT_FALSE(ParsePermissions("daring", "").ok());
  EXPECT_FALSE(ParsePermissions("safe", "anything").ok());
}

TEST(VerifyRules, NamesRuleFileAndBothLines) {
  EXPECT_EQ(FirstMessage(kHead + kSquare, kHead + kSquareTurned),
            "b:9: this outer wall is printed the other way round (direction; a:9)");
}

TEST(VerifyRules, ProgressKeepsItsSequence) {
  const std::string a = kHead + "M73 P1\n" + kSquare + "M73 P2\n" + kZigzag;
  EXPECT_EQ(
      Broken(a, With(With(With(a, "M73 P1", "M73 P3"), "M73 P2", "M73 P1"), "M73 P3", "M73 P2")),
      "progress");
  EXPECT_EQ(Broken(a, kHead + "M73 P1\nM73 P2\n" + kSquare + kZigzag), "");
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

TEST(VerifyRules, BoundsNoWayLeadsFarAway) {
  const std::string far = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X-90 Y5 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + far), "bounds");
  EXPECT_EQ(Broken(kHead + far, kHead + far), "");
  const std::string near = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X-1 Y5 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + near, kHead + near), "");
}

}  // namespace
}  // namespace traverse::gcode
