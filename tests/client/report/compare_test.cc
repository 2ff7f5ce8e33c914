// Strategies side by side: client/report/compare.

#include "client/report/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "absl/strings/str_split.h"
#include "client/report/json.h"
#include "client/report/numbers.h"
#include "client/report/table.h"
#include "tests/client/report/small_run.h"
#include "tests/support/golden.h"

namespace traverse::report {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<ComparedStrategy> TwoStrategies() {
  JobRun better = SmallRun();
  better.result.summary.mutable_travel()->set_total_mm(140);
  better.result.summary.clear_lower_bound();
  return {{"greedy", {SmallRun()}}, {"tabu:polish=false", {better}}};
}

TEST(CompareTable, ShowsGainsOverTheBaselines) {
  const std::string table = CompareTable(TwoStrategies(), Page(kPageWidth));

  EXPECT_TRUE(testing::MatchesGolden("report/compare.txt", table)) << table;
}

// The one with the longer travel takes less time: fewer retractions.
TEST(CompareTable, ComparesTheTimeOfTravelWhereThatIsTheCost) {
  std::vector<ComparedStrategy> strategies = TwoStrategies();
  v1::JobSummary& greedy = strategies[0].runs[0].result.summary;
  v1::JobSummary& tabu = strategies[1].runs[0].result.summary;
  for (v1::JobSummary* summary : {&greedy, &tabu}) summary->set_cost_given(20);
  greedy.set_cost(10);
  tabu.set_cost(15);

  const std::string table = CompareTable(strategies, Page(kPageWidth), CompareBy::kTime);

  EXPECT_THAT(table,
              AllOf(HasSubstr("travel s"), HasSubstr("travel mm"), Not(HasSubstr("idle s"))));
  EXPECT_THAT(table, ContainsRegex("greedy +10\\.00 .* 50\\.0 +0\\.0 "));
  EXPECT_THAT(table, ContainsRegex("tabu:polish=false +15\\.00 .* 25\\.0 +-50\\.0 "));
  EXPECT_LT(ComparedValue(strategies[0].runs[0], CompareBy::kTime),
            ComparedValue(strategies[1].runs[0], CompareBy::kTime));
  EXPECT_GT(ComparedValue(strategies[0].runs[0], CompareBy::kLength),
            ComparedValue(strategies[1].runs[0], CompareBy::kLength));
  v1::JobOptions options;
  EXPECT_EQ(CompareByOf(options), CompareBy::kLength);
  options.mutable_cost()->mutable_time();
  EXPECT_EQ(CompareByOf(options), CompareBy::kTime);
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

}  // namespace
}  // namespace traverse::report
