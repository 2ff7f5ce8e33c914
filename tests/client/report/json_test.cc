// Routes and comparisons as JSON: client/report/json.

#include "client/report/json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/formats/read_input.h"
#include "client/report/compare.h"
#include "tests/client/report/small_run.h"
#include "tests/support/golden.h"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(RoutesJson, MatchesItsGolden) {
  EXPECT_TRUE(testing::MatchesGolden("report/routes.json", RoutesJson(SmallJob(), SmallRun())));
}

TEST(RoutesJson, BoundsAreStatedOnlyForLengthAndOnlyIfAllAreKnown) {
  InputJob job = SmallJob();
  JobRun run = SmallRun();
  run.result.layers[1].clear_lower_bound();
  EXPECT_THAT(RoutesJson(job, run), HasSubstr("\"cleaning_mm\":10.0,\"lower_bound_mm\":null"));
  EXPECT_THAT(RoutesJson(job, run), HasSubstr("\"lower_bound_mm\":0.25"));

  job.options.mutable_cost()->mutable_time();
  EXPECT_THAT(RoutesJson(job, run), Not(HasSubstr("\"lower_bound_mm\":0.25")));
}

TEST(RoutesJson, HasTheBoundOfAllLayersTogetherIfThereIsOne) {
  InputJob job = SmallJob();
  JobRun run = SmallRun();
  EXPECT_THAT(RoutesJson(job, run), Not(HasSubstr("chain_lower_bound_mm")));

  run.result.summary.set_chain_lower_bound(0.125);
  EXPECT_THAT(RoutesJson(job, run), HasSubstr("\"chain_lower_bound_mm\":0.125}"));

  job.layers[1].mutable_cost()->mutable_time();
  EXPECT_THAT(RoutesJson(job, run), Not(HasSubstr("chain_lower_bound_mm")));
}

TEST(RoutesJson, HasWhatTheSearchTellsOfItself) {
  JobRun run = SmallRun();
  (*run.result.layers[1].mutable_statistics())["points_sp"] = 17;
  (*run.result.layers[1].mutable_statistics())["evaluations"] = 2.5;

  const std::string json = RoutesJson(SmallJob(), run);

  EXPECT_THAT(json, HasSubstr("\"statistics\":{\"evaluations\":2.5,\"points_sp\":17.0},\"route\""));
  EXPECT_THAT(RoutesJson(SmallJob(), SmallRun()), Not(HasSubstr("statistics")));
}

TEST(CompareJson, HoldsEachRunsDocument) {
  const std::string json = CompareJson(SmallJob(), {{"a", {SmallRun()}}, {"b", {SmallRun()}}});

  EXPECT_THAT(json, HasSubstr("{\"label\": \"a\", \"seed\": 18446744073709551615, \"routes\": {"));
  EXPECT_THAT(json, HasSubstr("{\"label\": \"b\""));
}

}  // namespace
}  // namespace traverse::report
