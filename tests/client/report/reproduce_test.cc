#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "absl/strings/str_cat.h"
#include "client/report/reproduce/figures_page.h"
#include "client/report/reproduce/outcomes.h"
#include "client/report/reproduce/paper_table.h"
#include "client/report/reproduce/sample.h"
#include "client/report/reproduce/thesis_tables.h"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// The first column of thesis table 3.2, and what equation 3.2 makes of it there.
TEST(SampleSize, IsThatOfThesisTable32) {
  const Sample sample =
      SampleOf({543.98, 611.47, 593.42, 559.15, 559.82, 551.18, 555.14, 547.58, 541.46, 575.58});

  EXPECT_EQ(sample.size, 10);
  EXPECT_NEAR(sample.mean, 563.88, 0.005);
  EXPECT_NEAR(sample.deviation, 22.89, 0.005);
  EXPECT_NEAR(SamplesNeeded(sample), 3.37, 0.005);
  EXPECT_EQ(SamplesNeeded({1, 5, 0}), 0);
}

ReproduceForm Tiny() {
  ReproduceForm form;
  form.seeds = 2;
  form.first_samples = 2;
  return form;
}

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

TEST(OutcomeFile, GoesOnFromWhatWasFinished) {
  const std::string name =
      (std::filesystem::path(::testing::TempDir()) / "reproduce_outcomes.jsonl").string();
  std::filesystem::remove(name);
  RunOutcome outcome;
  outcome.values["c_mm"] = 12.5;
  outcome.first_layer = {{1, 2, 3, 4, true}};
  {
    absl::StatusOr<OutcomeFile> file = OutcomeFile::Open(name);
    ASSERT_TRUE(file.ok()) << file.status();
    ASSERT_TRUE(file->Add("part1 none", outcome).ok());
  }
  std::ofstream(name, std::ios::app) << "{\"run\": \"part2 no";  // cut short

  absl::StatusOr<OutcomeFile> again = OutcomeFile::Open(name);

  ASSERT_TRUE(again.ok()) << again.status();
  ASSERT_NE(again->Find("part1 none"), nullptr);
  EXPECT_EQ(again->Find("part1 none")->Get("c_mm"), 12.5);
  EXPECT_TRUE(again->Find("part1 none")->first_layer.at(0).to_contour);
  EXPECT_EQ(again->Find("part2 none"), nullptr);
  std::ofstream(name) << "hello\n{}\n";
  EXPECT_EQ(OutcomeFile::Open(name).status().message(), name + ":1: no outcome of a run");
  std::filesystem::remove(name);
}

}  // namespace
}  // namespace traverse::report
