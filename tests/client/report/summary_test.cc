// What a run gained: client/report/summary.

#include "client/report/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/report/small_run.h"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;

TEST(OptimizeSummary, SaysWhatWasGained) {
  const std::string text = OptimizeSummary(SmallJob(), SmallRun());

  EXPECT_THAT(text, HasSubstr("2 layers, exact, 1.5 s\n"));
  EXPECT_THAT(text, HasSubstr("travel   220.0 mm -> 160.0 mm  (27.3 % less)\n"));
  EXPECT_THAT(text, HasSubstr("gap      20.0 % to a proven lower bound\n"));
  EXPECT_THAT(text, HasSubstr("ended    OPTIMAL 1\n"));
}

}  // namespace
}  // namespace traverse::report
