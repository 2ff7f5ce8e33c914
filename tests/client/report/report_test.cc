// Texts and documents made of results: client/report.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_split.h"
#include "client/formats/read_input.h"
#include "client/report/compare.h"
#include "client/report/inspection.h"
#include "client/report/json.h"
#include "client/report/numbers.h"
#include "client/report/reductions.h"
#include "client/report/summary.h"
#include "client/report/table.h"
#include "tests/support/golden.h"

namespace traverse::report {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// A job of one layer of islands and one plan, with notes.
InputJob SmallJob() {
  InputJob job = *ReadInput(testing::DataPath("damat/two_islands.damat"));
  job.name = "dir/\"odd\" \xff.damat";
  job.layers.resize(1);
  v1::Layer& plan = job.layers.emplace_back();
  plan.set_id(8);
  v1::Contour& contour = *plan.mutable_plan()->add_paths()->mutable_contour();
  contour.set_id(3);
  contour.add_points(0);
  contour.add_points(0);
  plan.mutable_plan()->add_paths()->mutable_open_path()->set_id(4);
  job.facts = {{"slicer", "none"}, {"longer than the rest", "1"}};
  job.notes = {{}, {{0, 1}, {5, 6}}};
  return job;
}

void AddVisit(v1::LayerResult& layer, uint32_t island, bool contour, uint32_t path,
              uint32_t entry) {
  v1::Visit& visit = *layer.add_visits();
  visit.set_island(island);
  if (contour) {
    visit.set_contour(path);
    visit.set_vertex(entry);
  } else {
    visit.set_raster(path);
    visit.set_reversed(entry != 0);
  }
}

JobRun SmallRun() {
  JobRun run;
  run.seed = 18446744073709551615u;
  run.wall_seconds = 1.5;
  v1::LayerResult& islands = run.result.layers.emplace_back();
  AddVisit(islands, 1, true, 0, 0);
  AddVisit(islands, 0, true, 1, 2);
  AddVisit(islands, 0, true, 0, 3);
  AddVisit(islands, 0, false, 1, 1);
  AddVisit(islands, 0, false, 0, 0);
  islands.mutable_start()->set_x_mm(0.1);
  islands.mutable_given()->set_total_mm(100);
  islands.mutable_travel()->set_total_mm(1.0 / 3);
  islands.set_lower_bound(0.25);
  islands.set_stop_reason(v1::STOP_REASON_OPTIMAL);
  islands.set_solve_seconds(0.125);
  v1::LayerResult& plan = run.result.layers.emplace_back();
  plan.add_visits()->set_plan_path(1);
  plan.mutable_visits(0)->set_reversed(true);
  plan.add_visits()->set_plan_path(0);
  plan.mutable_visits(1)->set_vertex(0);
  plan.set_lower_bound(0.5);
  plan.set_stop_reason(v1::STOP_REASON_TIME_LIMIT);
  v1::JobSummary& summary = run.result.summary;
  summary.set_strategy("exact");
  summary.mutable_given()->set_total_mm(200);
  summary.mutable_given()->set_contours_mm(150);
  summary.mutable_travel()->set_total_mm(150);
  summary.mutable_travel()->set_contours_mm(90);
  summary.mutable_travel()->set_rasters_mm(50);
  summary.mutable_travel()->set_links_mm(10);
  summary.set_cleaning_mm(10);
  summary.set_cleaning_given_mm(20);
  summary.set_cost(150);
  summary.set_lower_bound(120);
  summary.set_idle_seconds_given(11);
  summary.set_idle_seconds(8);
  summary.set_compute_seconds(2.5);
  v1::StopCount& stop = *summary.add_stops();
  stop.set_stop_reason(v1::STOP_REASON_OPTIMAL);
  stop.set_layers(1);
  return run;
}

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

std::vector<ComparedStrategy> TwoStrategies() {
  JobRun better = SmallRun();
  better.result.summary.mutable_travel()->set_total_mm(140);
  better.result.summary.clear_lower_bound();
  return {{"greedy", {SmallRun()}}, {"tabu:polish=false", {better}}};
}

TextStyle Page(int width) {
  TextStyle style;
  style.width = width;
  return style;
}

TEST(CompareTable, ShowsGainsOverTheBaselines) {
  const std::string table = CompareTable(TwoStrategies(), Page(kPageWidth));

  EXPECT_TRUE(testing::MatchesGolden("report/compare.txt", table)) << table;
}

TEST(CompareTable, ShowsMeanAndDeviationOfRepeatedRuns) {
  JobRun one = SmallRun();
  JobRun two = SmallRun();
  two.result.summary.mutable_travel()->set_total_mm(152);

  const std::string table = CompareTable({{"tabu", {one, two}}}, Page(kPageWidth));

  EXPECT_TRUE(testing::MatchesGolden("report/compare_repeated.txt", table)) << table;
}

TEST(CompareTable, LeavesOutColumnsWhereThereIsNoRoom) {
  const auto lines_fit = [](const std::string& table, size_t width) {
    for (const std::string& line : std::vector<std::string>(absl::StrSplit(table, '\n'))) {
      if (TextWidth(line) > width) return false;
    }
    return true;
  };
  const std::string full = CompareTable(TwoStrategies(), Page(kPageWidth));
  const std::string narrow = CompareTable(TwoStrategies(), Page(115));
  const std::string narrower = CompareTable(TwoStrategies(), Page(100));
  const std::string narrowest = CompareTable(TwoStrategies(), Page(80));

  EXPECT_THAT(full, AllOf(HasSubstr("idle s"), HasSubstr("contours"), HasSubstr("gain")));
  EXPECT_THAT(narrow, AllOf(HasSubstr("idle s"), HasSubstr("contours"), Not(HasSubstr("gain"))));
  EXPECT_THAT(narrower, AllOf(Not(HasSubstr("idle s")), HasSubstr("contours")));
  EXPECT_THAT(narrowest, Not(HasSubstr("contours")));
  EXPECT_TRUE(lines_fit(full, kPageWidth) && lines_fit(narrow, 115) && lines_fit(narrower, 100) &&
              lines_fit(narrowest, 80));
}

TEST(CompareTable, FoldsLongLabelsBeforeItLeavesOutNumbers) {
  std::vector<ComparedStrategy> strategies = TwoStrategies();
  strategies[1].label = "tabu:polish=false:representation=nrp:diversifications=5000";

  const std::string table = CompareTable(strategies, Page(115));

  EXPECT_THAT(table, HasSubstr("idle s"));
  EXPECT_THAT(table, AllOf(HasSubstr("\ntabu:polish=false  "), HasSubstr("\n  :representation=nrp"),
                           HasSubstr("\n  :diversifications=5000")));
  EXPECT_THAT(CompareTable(strategies, Page(200)), HasSubstr("\n" + strategies[1].label + " "));
}

TEST(FoldAtColons, KeepsPiecesWhole) {
  EXPECT_THAT(FoldAtColons("tabu", 2), ElementsAre("tabu"));
  EXPECT_THAT(FoldAtColons("a:b:cc", 100), ElementsAre("a:b:cc"));
  EXPECT_THAT(FoldAtColons("a:b:cc:dddddd", 5), ElementsAre("a:b", "  :cc", "  :dddddd"));
  EXPECT_THAT(FoldAtColons("", 5), ElementsAre(""));
}

// The rows of thesis tables 5.1 and 5.4.
TEST(ReductionTable, ShowsWhatEachReductionLeavesOfALayersPoints) {
  JobRun one = SmallRun();
  JobRun two = SmallRun();
  for (const auto& [name, points] : std::map<std::string, double>{{"points_entries", 1000},
                                                                  {"points_island_analysis", 750},
                                                                  {"points_sp", 400},
                                                                  {"points_bbcp", 20},
                                                                  {"points_vp", 100}}) {
    (*one.result.layers[0].mutable_statistics())[name] = points;
    (*two.result.layers[0].mutable_statistics())[name] = points;
  }
  (*two.result.layers[0].mutable_statistics())["points_vp"] = 140;

  const std::string table =
      ReductionTable({{"greedy", {SmallRun()}}, {"tabu", {one, two}}}, Page(kPageWidth));

  EXPECT_THAT(table, Not(HasSubstr("greedy")));
  for (const char* cell :
       {" 1000 ", "750 (-25.0 %)", "400 (-60.0 %)", "20 (-98.0 %)", "120 (-70.0 %)"}) {
    EXPECT_THAT(table, HasSubstr(cell));
  }
  EXPECT_EQ(ReductionTable({{"greedy", {SmallRun()}}}, Page(kPageWidth)), "");
}

TEST(CompareTable, MarksTheBestAndTheWorseInColorAlone) {
  TextStyle style = Page(kPageWidth);
  style.color = true;
  std::vector<ComparedStrategy> strategies = TwoStrategies();
  strategies[0].runs[0].result.summary.mutable_travel()->set_total_mm(500);

  const std::string table = CompareTable(strategies, style);

  EXPECT_THAT(table, HasSubstr("\x1b[1;32m150.00\x1b[0m"));
  EXPECT_THAT(table, HasSubstr("\x1b[31m-131.8\x1b[0m"));
  EXPECT_THAT(CompareTable(strategies, Page(kPageWidth)), Not(HasSubstr("\x1b")));
}

TEST(Bar, HasEighthsOfAColumn) {
  TextStyle plain;
  plain.blocks = false;

  EXPECT_EQ(Bar(0.5, 10, {}), "\u2588\u2588\u2588\u2588\u2588");
  EXPECT_EQ(Bar(0.0125, 10, {}), "\u258f");
  EXPECT_EQ(Bar(0.5, 10, plain), "#####");
  EXPECT_EQ(Bar(-1, 10, plain), "");
  EXPECT_EQ(Bar(2, 10, plain), "##########");
}

TEST(OptimizeSummary, SaysWhatWasGained) {
  const std::string text = OptimizeSummary(SmallJob(), SmallRun());

  EXPECT_THAT(text, HasSubstr("2 layers, exact, 1.5 s\n"));
  EXPECT_THAT(text, HasSubstr("travel   220.0 mm -> 160.0 mm  (27.3 % less)\n"));
  EXPECT_THAT(text, HasSubstr("gap      20.0 % to a proven bound\n"));
  EXPECT_THAT(text, HasSubstr("ended    OPTIMAL 1\n"));
}

TEST(InspectionText, CountsPathsByKindAndStatesTheFilesFacts) {
  InputJob job = SmallJob();
  job.name = "part.damat";

  const std::string text = InspectionText(job, SmallRun().result, 10);

  EXPECT_TRUE(testing::MatchesGolden("report/inspection.txt", text)) << text;
  EXPECT_THAT(InspectionText(job, SmallRun().result, 1), Not(HasSubstr("layer  id")));
}

TEST(Table, SetsTheFirstColumnLeftAndTheOthersRight) {
  Table table({"name", "µm"});
  table.Add({{"a"}, {"1"}});
  table.Add({{"bcdefg"}, {"1000"}});

  EXPECT_EQ(table.Text(), "name      µm\n------  ----\na          1\nbcdefg  1000\n");
}

TEST(Numbers, ReadWell) {
  EXPECT_EQ(Change(100, 68.8), "31.2 % less");
  EXPECT_EQ(Change(100, 104), "4.0 % more");
  EXPECT_EQ(Change(100, 100.01), "the same");
  EXPECT_EQ(Change(0, 0), "the same");
  EXPECT_EQ(Change(0, 5), "100.0 % more");
  EXPECT_EQ(Duration(0.44), "0.4 s");
  EXPECT_EQ(Duration(9.96), "10 s");
  EXPECT_EQ(Duration(59.6), "1 min 0 s");
  EXPECT_EQ(Duration(39060), "10 h 51 min");
  EXPECT_EQ(Duration(273600), "3 d 4 h");
  EXPECT_EQ(Length(812.44), "812.4 mm");
  EXPECT_EQ(Length(15024.2), "15.02 m");
  EXPECT_EQ(Length(593331), "593.3 m");
  EXPECT_EQ(Length(12'440'000), "12.44 km");
}

}  // namespace
}  // namespace traverse::report
