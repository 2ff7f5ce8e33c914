// What may have changed, by flags and by the line at the head: client/gcode/verify/permissions.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

TEST(PermissionsInHead, ThePolicyIsThatOfTheFlagsOrOfTheLineAtTheHead) {
  const std::string a = kHead + kSquare;
  const std::string b = kHead + kSquareElsewhere;
  const std::string says = "; optimised by Traverse 1.0, policy balanced: travel\n";

  EXPECT_EQ(FirstMessage(a, says + b), "");
  EXPECT_THAT(FirstMessage(a, b), HasSubstr("seam"));
  EXPECT_EQ(Broken(a, says + b, Policy::kSafe), "seam");
  EXPECT_EQ(Broken(a, b, Policy::kFree), "");
  const std::string mark = "\xEF\xBB\xBF; of UTF-8\n";
  EXPECT_EQ(FirstMessage(mark + a, mark + says + b), "");
  // Behind a command it is not at the head.
  EXPECT_THAT(FirstMessage(a, With(b, "M83\n", "M83\n" + says)), HasSubstr("seam"));
}

TEST(PermissionsInHead, WhatIsAllowedIsReadFromTheLineToo) {
  const auto head = PermissionsInHead(
      ";FLAVOR:Marlin\n; optimised by Traverse 1.0, policy safe, allow wall_order+fan_order: x\n");
  ASSERT_TRUE(head.has_value());
  EXPECT_EQ(DescribePermissions(*head), "safe, wall_order, fan_order");
  EXPECT_FALSE(PermissionsInHead("; optimised by Traverse 1.0: x\n").has_value());
  EXPECT_FALSE(ParsePermissions("daring", "").ok());
  EXPECT_FALSE(ParsePermissions("safe", "anything").ok());
}

TEST(PermissionsInHead, FastIsAsFreeAndNeedsNoWipes) {
  const auto head = PermissionsInHead("; optimised by Traverse 1.0, policy fast: x\n");
  ASSERT_TRUE(head.has_value());
  EXPECT_EQ(DescribePermissions(*head), "fast");
  EXPECT_TRUE(head->is_free());
  EXPECT_TRUE(head->drops_wipes());
  EXPECT_EQ(Broken(kHead + kSquare, kHead + kSquareElsewhere, Policy::kFast), "");
  EXPECT_FALSE(ParsePermissions("free", "")->drops_wipes());
}

TEST(PermissionsFor, WhatIsGivenComesBeforeWhatTheFileStates) {
  const std::string_view stated = "; optimised by Traverse 1.0, policy free, allow wall_order: x\n";
  const auto described = [](const std::optional<GivenPermissions>& given, std::string_view text) {
    return DescribePermissions(PermissionsFor(given, text));
  };
  EXPECT_EQ(described(std::nullopt, stated), "free, wall_order");
  EXPECT_EQ(described(std::nullopt, "G1 X1\n"), "safe");
  EXPECT_EQ(described(GivenPermissions{}, stated), "safe");
  EXPECT_EQ(described(GivenPermissions{{}, /*policy_as_stated=*/true}, stated), "free");
  VerifyPermissions allowed;
  allowed.infill_order = true;
  EXPECT_EQ(described(GivenPermissions{allowed, true}, stated), "free, infill_order");
  EXPECT_EQ(described(GivenPermissions{allowed, true}, "G1 X1\n"), "safe, infill_order");
}

TEST(PermissionsInHead, TheLineOfTheWriterIsInTheHeadAndNotInAPicture) {
  const std::string says = "; optimised by Traverse 1.0, policy safe: x\n";
  const std::string picture = "; thumbnail begin 16x16 8\n; abcd\n; thumbnail end\n";
  const std::string a = picture + kHead + kTwo;
  EXPECT_EQ(Broken(a, picture + says + kHead + kTwo), "");
  EXPECT_EQ(Broken(a, says + a), "");
  EXPECT_EQ(Broken(a, With(a, "; abcd\n", says + "; abcd\n")), "same_print");
  EXPECT_EQ(Broken(a, picture + kHead + kOne + says + kOther), "same_print");
}

// Nothing is compared with it, so it may not be there more often than the writer leaves it.
TEST(PermissionsInHead, ASecondLineOfTheWriterIsRefused) {
  const std::string says = "; optimised by Traverse 1.0, policy safe: x\n";
  const std::string print = kHead + kTwo;
  EXPECT_EQ(Broken(print, says + print), "");
  EXPECT_EQ(Broken(print, says + says + print), "same_print");
  EXPECT_EQ(Broken(says + print, says + "; optimised by Traverse\n" + print), "same_print");
  EXPECT_EQ(Broken(says + says + print, says + print), "");
}

}  // namespace
}  // namespace traverse::gcode
