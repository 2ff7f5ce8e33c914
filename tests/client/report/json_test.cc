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

TEST(RoutesJson, StatesWhatIsPaidWhereTheCostIsTime) {
  InputJob job = SmallJob();
  JobRun run = SmallRun();
  EXPECT_THAT(RoutesJson(job, run), Not(HasSubstr("cost_seconds")));

  job.layers[1].mutable_cost()->mutable_time();
  v1::LayerResult& plan = run.result.layers[1];
  plan.set_cost_given(4);
  plan.set_cost(2.5);
  plan.set_crossings_given(7);
  plan.set_crossings(6);
  plan.set_retractions_given(3);
  plan.set_retractions(2);
  v1::Detour& detour = *plan.add_detours();
  detour.set_visit(1);
  detour.add_points(0.5);
  detour.add_points(-8);
  EXPECT_THAT(RoutesJson(job, run),
              HasSubstr("\"lower_bound_mm\":null,\"cost_given_seconds\":4.0,\"cost_seconds\":2.5,"
                        "\"lower_bound_seconds\":0.5,\"crossings_given\":7,\"crossings\":6,"
                        "\"retractions_given\":3,\"retractions\":2,\"stop\""));
  EXPECT_THAT(RoutesJson(job, run),
              HasSubstr("\"detours\":[{\"visit\":1,\"points\":[0.5,-8.0]}]}"));
  EXPECT_THAT(RoutesJson(job, run), Not(HasSubstr("\"cost_seconds\":150")));

  job.layers[0].mutable_cost()->mutable_time();
  run.result.summary.set_chain_lower_bound(100);
  EXPECT_THAT(RoutesJson(job, run), HasSubstr("\"cost_seconds\":150.0"));
  EXPECT_THAT(RoutesJson(job, run), HasSubstr("\"chain_lower_bound_seconds\":100.0"));
}

TEST(RoutesJson, StatesOfANewFileWhatWasWrittenNotWhatTheSearchKnew) {
  GcodeRewrite rewrite;
  rewrite.before = {.travel_mm = 70, .retractions = 8, .crossings = 9};
  rewrite.after = {.travel_mm = 50, .retractions = 6, .crossings = 5};
  rewrite.forecast = {.given_seconds = 11, .seconds = 10};
  const std::string json = RoutesJson(SmallJob(), SmallRun(), &rewrite);
  EXPECT_THAT(json, HasSubstr("\"total\": {\"travel_given_mm\":70.0,\"travel_mm\":50.0,"));
  EXPECT_THAT(json, HasSubstr("\"cost_given_seconds\":11.0,\"cost_seconds\":10.0,"
                              "\"lower_bound_seconds\":null,\"crossings_given\":9,"
                              "\"crossings\":5,\"retractions_given\":8,\"retractions\":6}"));
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
