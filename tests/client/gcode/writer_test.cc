// Writing layers in other orders: client/gcode/layer_writer.h and what it is made of.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/reader.h"
#include "client/gcode/rewrite.h"
#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/corpus.h"
#include "tests/client/gcode/random_order.h"
#include "tests/client/gcode/samples.h"

namespace traverse::gcode {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::shared_ptr<GcodeFile> Read(const std::string& text) {
  absl::StatusOr<std::shared_ptr<GcodeFile>> file = ReadGcode(text, "part.gcode");
  EXPECT_TRUE(file.ok()) << file.status();
  return *file;
}

class ShuffledFile : public ::testing::TestWithParam<std::string> {};

// Whatever order a plan allows, what is written prints the same. The routes that the service finds
// are a few of these.
TEST_P(ShuffledFile, PrintsTheSame) {
  const std::string text = testing::TextOf(GetParam());
  const auto file = Read(text);
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    for (uint64_t seed = 1; seed <= 2; ++seed) {
      const std::string shuffled = testing::Shuffled(*file, policy, seed);
      EXPECT_EQ(VerifyGcode(text, "original", shuffled, "shuffled").message(), "")
          << PolicyName(policy) << " seed " << seed;
    }
  }
}

std::string TestName(const ::testing::TestParamInfo<std::string>& info) {
  return testing::NameOf(info.param);
}

INSTANTIATE_TEST_SUITE_P(Kept, ShuffledFile, ::testing::ValuesIn(testing::KeptFiles()), TestName);

}  // namespace
}  // namespace traverse::gcode
