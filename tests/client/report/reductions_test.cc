// What each reduction leaves: client/report/reductions.

#include "client/report/reductions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "client/report/compare.h"
#include "client/report/json.h"
#include "client/report/table.h"
#include "tests/client/report/small_run.h"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

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

}  // namespace
}  // namespace traverse::report
