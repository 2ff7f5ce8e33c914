// The paper's table with our figures: client/report/reproduce/paper_table.

#include "client/report/reproduce/paper_table.h"

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

// The paper's own rows come out of its own figures: peca 1, Nc = 2 is 2.08 % over Metodo 1.
TEST(PaperTable, SetsOursBesideTheirs) {
  const ReproduceForm form = Tiny();
  std::map<std::string, RunOutcome> outcomes;
  for (const PlannedRun& run : PaperRuns(form)) {
    RunOutcome& outcome = outcomes[run.Key()];
    outcome.values["c_mm"] = run.method == ReleaseMethod() ? 80 : 100;
    outcome.values["cleaning_mm"] = 100;
  }
  const std::string text = PaperTable(form, [&](const PlannedRun& run) {
    const auto found = outcomes.find(run.Key());
    return found == outcomes.end() ? nullptr : &found->second;
  });

  EXPECT_THAT(text, HasSubstr("Método 3 em relação ao Método 1"));
  EXPECT_THAT(text, HasSubstr("Método 3 em relação ao Método 2"));
  EXPECT_THAT(text, HasSubstr("10.00"));  // 180 for 200, cleaning included
  EXPECT_THAT(text, HasSubstr("-3.65"));  // theirs
  EXPECT_THAT(text, HasSubstr("sem limpeza"));
}

}  // namespace
}  // namespace traverse::report
