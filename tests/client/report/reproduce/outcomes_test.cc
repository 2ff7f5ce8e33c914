// What runs came to, kept in a file: client/report/reproduce/outcomes.

#include "client/report/reproduce/outcomes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "client/report/reproduce/figures_page.h"

namespace traverse::report {
namespace {

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

TEST(OutcomeFile, RefusesLinesThatItDoesNotWrite) {
  const std::string name =
      (std::filesystem::path(::testing::TempDir()) / "reproduce_odd.jsonl").string();
  for (const char* const line :
       {"[]", R"({"run":1,"values":{},"moves":[]})", R"({"run":"a","values":{"x":"y"},"moves":[]})",
        R"({"run":"a","values":{},"moves":[[1,2,3,4]]})",
        R"({"run":"a","values":{},"moves":[[1,2,3,4,"x"]]})"}) {
    std::ofstream(name) << line << "\n\n";
    EXPECT_EQ(OutcomeFile::Open(name).status().message(), name + ":1: no outcome of a run") << line;
  }
  std::filesystem::remove(name);
}

}  // namespace
}  // namespace traverse::report
