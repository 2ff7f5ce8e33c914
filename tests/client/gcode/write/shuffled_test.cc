// Any order that a plan allows prints the same.

#include <gtest/gtest.h>

#include <string>

#include "client/gcode/rewrite.h"
#include "tests/client/gcode/support/corpus.h"
#include "tests/client/gcode/support/random_order.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/verified.h"

namespace traverse::gcode {
namespace {

using testing::Read;

class ShuffledFile : public ::testing::TestWithParam<std::string> {};

std::string TestName(const ::testing::TestParamInfo<std::string>& info) {
  return testing::NameOf(info.param);
}

// Whatever order a plan allows, what is written prints the same. The routes that the service finds
// are a few of these.
TEST_P(ShuffledFile, PrintsTheSame) {
  const std::string text = testing::TextOf(GetParam());
  const auto file = Read(text);
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    const std::string shuffled = testing::Shuffled(*file, policy, 1);
    EXPECT_EQ(VerifyGcode(text, "original", shuffled, "shuffled", OnlySamePrint()).message(), "")
        << PolicyName(policy);
  }
}

INSTANTIATE_TEST_SUITE_P(Kept, ShuffledFile, ::testing::ValuesIn(testing::KeptFiles()), TestName);

}  // namespace
}  // namespace traverse::gcode
