#include "client/cli/flags/strategy_spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace traverse::cli {
namespace {

using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;
using Options = std::vector<std::pair<std::string, std::string>>;

v1::ListStrategiesResponse Known() {
  v1::ListStrategiesResponse known;
  known.add_strategies()->set_name("none");
  v1::StrategyInfo& ni2opt = *known.add_strategies();
  ni2opt.set_name("ni2opt");
  ni2opt.add_options()->set_name("point_release");
  v1::StrategyInfo& tabu = *known.add_strategies();
  tabu.set_name("tabu");
  tabu.add_options()->set_name("tenure");
  tabu.add_options()->set_name("polish");
  return known;
}

std::string ErrorOf(const std::string& text, const Options& options = {}) {
  auto specs = ParseStrategySpecs(text);
  absl::Status status = specs.status();
  if (status.ok()) status = ResolveStrategies(Known(), options, *specs);
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  return std::string(status.message());
}

TEST(StrategySpec, HoldsNamesAndOptions) {
  auto specs = *ParseStrategySpecs("none,tabu:tenure=5:polish=false,tabu");

  ASSERT_THAT(specs, SizeIs(3));
  EXPECT_EQ(specs[1].label, "tabu:tenure=5:polish=false");
  EXPECT_EQ(specs[1].strategy.name(), "tabu");
  EXPECT_THAT(specs[1].strategy.options(),
              UnorderedElementsAre(Pair("tenure", "5"), Pair("polish", "false")));
  EXPECT_TRUE(ResolveStrategies(Known(), {}, specs).ok());
}

TEST(StrategySpec, TheNameOfASwitchAloneTurnsItOn) {
  auto specs = *ParseStrategySpecs("tabu:polish:tenure=5");

  ASSERT_THAT(specs, SizeIs(1));
  EXPECT_EQ(specs[0].label, "tabu:polish:tenure=5");
  EXPECT_THAT(specs[0].strategy.options(),
              UnorderedElementsAre(Pair("tenure", "5"), Pair("polish", "true")));
}

TEST(StrategySpec, OptionsGoToWhomTheyFitButOverrideNothing) {
  auto specs = *ParseStrategySpecs("none,tabu:tenure=5,tabu");

  ASSERT_TRUE(ResolveStrategies(Known(), {{"tenure", "9"}, {"polish", "true"}}, specs).ok());

  EXPECT_THAT(specs[0].strategy.options(), SizeIs(0));
  EXPECT_THAT(specs[1].strategy.options(),
              UnorderedElementsAre(Pair("tenure", "5"), Pair("polish", "true")));
  EXPECT_THAT(specs[2].strategy.options(),
              UnorderedElementsAre(Pair("tenure", "9"), Pair("polish", "true")));
}

TEST(StrategySpec, ErrorsSayWhatWasMeant) {
  EXPECT_EQ(ErrorOf("tabo"),
            "unknown strategy \"tabo\"; did you mean tabu? (`traverse strategies` lists them)");
  EXPECT_EQ(ErrorOf(""), "\"\" does not name a strategy");
  EXPECT_EQ(ErrorOf("none,,tabu"), "\"none,,tabu\" does not name a strategy");
  EXPECT_EQ(ErrorOf("tabu:"), "option \"\" is not NAME=VALUE");
  EXPECT_EQ(ErrorOf("tabu:polsh"), "tabu has no option \"polsh\"; did you mean polish?");
  EXPECT_EQ(ErrorOf("tabu:=1"), "option \"=1\" is not NAME=VALUE");
  EXPECT_EQ(ErrorOf("tabu:polsh=1"), "tabu has no option \"polsh\"; did you mean polish?");
  EXPECT_EQ(ErrorOf("none", {{"tenure", "5"}}),
            "--option=tenure: none of the strategies has this option");
  EXPECT_EQ(ErrorOf("none,tabu", {{"tenur", "5"}}),
            "--option=tenur: none of the strategies has this option; did you mean tenure?");
}

}  // namespace
}  // namespace traverse::cli
