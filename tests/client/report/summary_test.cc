// What a run gained: client/report/summary.

#include "client/report/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/client/report/small_run.h"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(OptimizeSummary, SaysWhatWasGained) {
  const std::string text = OptimizeSummary(SmallJob(), SmallRun());

  EXPECT_THAT(text, HasSubstr("2 layers, exact, 1.5 s\n"));
  EXPECT_THAT(text, HasSubstr("travel   220.0 mm -> 160.0 mm  (27.3 % less)\n"));
  EXPECT_THAT(text, HasSubstr("gap      20.0 % to a proven lower bound\n"));
  EXPECT_THAT(text, HasSubstr("ended    OPTIMAL 1\n"));
}

// Not what the first search took for found.
TEST(OptimizeSummary, StatesWhatTheWrittenOrdersAreTakenToCost) {
  InputJob job = SmallJob();
  job.options.mutable_cost()->mutable_time()->set_speed_mm_s(100);
  const gcode::Forecast forecast = {8, 6};

  const std::string written = OptimizeSummary(job, SmallRun(), &forecast);

  EXPECT_THAT(written, HasSubstr("cost     8.0 s -> 6.0 s  (25.0 % less)\n"));
  EXPECT_THAT(written, Not(HasSubstr("travel")));
  EXPECT_THAT(OptimizeSummary(job, SmallRun()), Not(HasSubstr("25.0 % less")));
}

// In sliced files nothing left of a bound does not mean that nothing more could be had.
TEST(OptimizeSummary, SaysNothingOfAGapThatTheRulesClose) {
  JobRun run = SmallRun();
  run.result.summary.set_lower_bound(0.9999 * run.result.summary.cost());
  const gcode::Forecast forecast = {8, 6};

  EXPECT_THAT(OptimizeSummary(SmallJob(), run), HasSubstr("gap      0.0 %"));
  EXPECT_THAT(OptimizeSummary(SmallJob(), run, &forecast), Not(HasSubstr("gap")));
}

TEST(OptimizeSummary, StatesTheBoundOfAllLayersTogetherIfThereIsOne) {
  JobRun run = SmallRun();
  EXPECT_THAT(OptimizeSummary(SmallJob(), run), Not(HasSubstr("chain")));

  run.result.summary.set_chain_lower_bound(0.75 * run.result.summary.cost());

  EXPECT_THAT(OptimizeSummary(SmallJob(), run),
              HasSubstr("chain    25.0 % to a proven lower bound of all layers together\n"));
}

}  // namespace
}  // namespace traverse::report
