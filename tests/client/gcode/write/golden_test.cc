// Small files before and after, to be read side by side: tests/data/gcode/golden/NAME.gcode, and
// NAME.POLICY.gcode with its paths in a random order of those that the policy allows.
//
// TRAVERSE_RENEW_GOLDEN=1 build/release/tests/client/gcode/gcode_tests --gtest_filter='*Golden*'
// writes the latter anew.

#include "tests/support/golden.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "client/gcode/read/reader.h"
#include "tests/client/gcode/support/corpus.h"
#include "tests/client/gcode/support/random_order.h"
#include "tests/client/gcode/support/verified.h"

namespace traverse::gcode {
namespace {

class Golden : public ::testing::TestWithParam<std::string> {
 protected:
  std::string Name(const std::string& rest) const {
    return absl::StrCat("gcode/golden/", GetParam(), rest);
  }
};

TEST_P(Golden, ReordersAsItDidWhenLookedAt) {
  const std::string text = testing::TextOf(traverse::testing::DataPath(Name(".gcode")));
  const auto file = ReadGcode(text, "original");
  ASSERT_TRUE(file.ok()) << file.status();
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    const std::string shuffled = testing::Shuffled(**file, policy, 3);

    EXPECT_EQ(VerifyGcode(text, "original", shuffled, "shuffled", OnlySamePrint()).message(), "");
    EXPECT_NE(shuffled, text);
    const std::string name = Name(absl::StrCat(".", std::string(PolicyName(policy)), ".gcode"));
    EXPECT_TRUE(traverse::testing::MatchesGolden(name, shuffled));
  }
}

INSTANTIATE_TEST_SUITE_P(Dialects, Golden, ::testing::Values("prusa", "orca", "slic3r", "cura"),
                         [](const auto& info) { return info.param; });

TEST(Golden, AnotherFileDoesNotMatch) {
  if (traverse::testing::RenewsGoldens()) GTEST_SKIP() << "renewing";
  EXPECT_FALSE(traverse::testing::MatchesGolden("gcode/golden/cura.safe.gcode", "G28\n"));
}

}  // namespace
}  // namespace traverse::gcode
