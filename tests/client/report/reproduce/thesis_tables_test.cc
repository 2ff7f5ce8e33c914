// The thesis's tables with our figures: client/report/reproduce/thesis_tables.

#include "client/report/reproduce/thesis_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "client/report/reproduce/figures_page.h"
#include "client/report/reproduce/outcomes.h"
#include "tests/client/report/reproduce/tiny_form.h"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ThesisTables, HaveEveryTableAndItsOwnFigures) {
  const ReproduceForm form = Tiny();
  std::map<std::string, RunOutcome> outcomes;
  for (const PlannedRun& run : ThesisRuns(form)) {
    RunOutcome& outcome = outcomes[run.Key()];
    outcome.values = {{"c_mm", 1000.0 + static_cast<double>(run.seed)},
                      {"crs_mm", 500},
                      {"layers", 5},
                      {"points_entries", 500},
                      {"points_sp", 250},
                      {"points_vp", 100},
                      {"points_nrp", 50},
                      {"points_bbcp", 20},
                      {"points_island_analysis", 400},
                      {"step2_seconds", 1.5}};
    if (run.method == MilpMethodName("sp", true, form)) {
      outcome.values["contours_programmes"] = 5;  // and found nothing
    }
  }
  const auto find = [&](const PlannedRun& run) -> const RunOutcome* {
    const auto found = outcomes.find(run.Key());
    return found == outcomes.end() ? nullptr : &found->second;
  };

  const std::string text = ThesisTables(form, find);

  for (const char* table : {"Tabela 3.1", "Tabela 3.2", "Tabela 5.1", "Tabela 5.2", "Tabela 5.3",
                            "Tabela 5.4", "Tabela 5.5", "Tabela 5.6", "Tabela 5.7", "Tabela 5.8",
                            "Figura 5.13", "Rota-C", "Rota-CRS", "Ganho sobre NI2OPT (%)"}) {
    EXPECT_THAT(text, HasSubstr(table));
  }
  EXPECT_THAT(text, HasSubstr("1501.50"));  // mean of two seeds
  EXPECT_THAT(text, HasSubstr("NA"));
  EXPECT_THAT(text, HasSubstr("5711.50"));  // theirs
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_THAT(ThesisTables(form, [](const PlannedRun&) { return nullptr; }), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace traverse::report
