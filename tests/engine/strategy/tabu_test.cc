#include "engine/strategy/tabu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <string>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;
using testing::OwnedProblem;
using testing::StatusIs;

Solution Solve(const std::string& strategy, const std::map<std::string, std::string>& options,
               const OwnedProblem& owned, Budget budget = {}) {
  return (*MakeStrategy(strategy, options))->Solve(owned.problem, budget);
}

TEST(Tabu, IsNeverBehindNi2opt) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 25});

    const Solution tabu = Solve("tabu", {{"diversifications", "10"}}, owned);

    ASSERT_OK(ValidateRoute(owned.plan(), tabu.route));
    EXPECT_LE(RouteCost(owned.problem, tabu.route),
              RouteCost(owned.problem, Solve("ni2opt", {}, owned).route) + 1e-9);
  }
}

TEST(Tabu, IsNotBehindNi2optWhenTimeIsShort) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(6, 6)));
  const double ni2opt = RouteCost(owned.problem, Solve("ni2opt", {}, owned).route);

  Budget budget = Budget().Within(std::chrono::milliseconds(200));
  const Solution tabu =
      (*MakeStrategy("tabu", {{"diversifications", "1000000"}}))->Solve(owned.problem, budget);

  EXPECT_EQ(tabu.stop, StopReason::kTimeLimit);
  EXPECT_LE(RouteCost(owned.problem, tabu.route), ni2opt + 1e-9);
}

// Its polishing goes on where the layer turns out to begin elsewhere.
TEST(Tabu, ResumesAsWellAsItSolves) {
  double solved = 0;
  double resumed = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    OwnedProblem owned = testing::RandomProblem(
        seed, {.shape = testing::PlanShape::kSequential, .min_paths = 20, .max_paths = 40});
    const auto tabu = *MakeStrategy("tabu", {{"diversifications", "20"}});
    Budget budget;
    const Route first = tabu->Solve(owned.problem, budget).route;
    owned.problem.start = {100 - owned.problem.start.x, 100 - owned.problem.start.y};

    resumed += RouteCost(owned.problem, tabu->Resume(owned.problem, first, budget).route);
    solved += RouteCost(owned.problem, tabu->Solve(owned.problem, budget).route);
  }
  EXPECT_LT(resumed, 1.01 * solved);
}

TEST(Tabu, WithoutPolishIsTheFrameworkOrGreedy) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(
        seed, {.shape = testing::PlanShape::kSequential, .min_paths = 1, .max_paths = 20});

    const Solution tabu = Solve("tabu", {{"diversifications", "10"}, {"polish", "false"}}, owned);

    const double greedy = RouteCost(owned.problem, Solve("greedy", {}, owned).route);
    EXPECT_NEAR(RouteCost(owned.problem, tabu.route),
                std::min(greedy, tabu.statistics.at("framework_cost")), 1e-9);
  }
}

TEST(Tabu, TellsWhatEachReductionLeaves) {
  const OwnedProblem owned(SequentialPlan(testing::PlateWithHoles()));

  const Solution nrp = Solve("tabu", {{"representation", "nrp"}, {"diversifications", "5"}}, owned);
  const Solution sp = Solve("tabu", {{"representation", "sp"}, {"diversifications", "5"}}, owned);

  EXPECT_THAT(nrp.statistics, Contains(Key("points_nrp")));
  EXPECT_THAT(sp.statistics, ::testing::Not(Contains(Key("points_nrp"))));
  EXPECT_EQ(sp.statistics.at("points_bbcp"), 4);
}

TEST(Tabu, TakesEveryOption) {
  const OwnedProblem owned(SequentialPlan(testing::PlateWithHoles()));
  for (const std::map<std::string, std::string>& options :
       std::vector<std::map<std::string, std::string>>{
           {{"diversification", "swaps"}, {"swaps", "1"}},
           {{"reactive", "true"}, {"tenure", "0"}},
           {{"list_size", "0"}, {"patience", "0"}},
           {{"neighbors", "3"}, {"first_radius_mm", "2"}, {"radius_step_mm", "1"}},
           {{"neighbor_penalty", "0"}, {"order_penalty", "0"}},
           {{"elite", "1"}, {"relinked", "0"}, {"spacing_mm", "0"}, {"representation", "sp"}}}) {
    EXPECT_OK(ValidateRoute(owned.plan(), Solve("tabu", options, owned).route));
  }
  EXPECT_THAT(
      MakeStrategy("tabu", {{"diversifications", "0"}}),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("options[\"diversifications\"]")));
}

TEST(Tabu, NumbersOfOptionsAreDecimal) {
  for (const char* text : {"2", "+2", "2e0"}) {
    const bool whole = std::string(text) != "2e0";
    EXPECT_EQ(MakeStrategy("tabu", {{"diversifications", text}}).ok(), whole) << text;
  }
  for (const char* text : {"0x2", "2 ", " 2", "2\n", "nan", ""}) {
    EXPECT_THAT(MakeStrategy("tabu", {{"diversifications", text}}).status(),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("a whole number")))
        << text;
  }
}

TEST(Tabu, SeedsLeadToOtherSearches) {
  OwnedProblem owned = testing::RandomProblem(
      7, {.shape = testing::PlanShape::kSequential, .min_paths = 40, .max_paths = 40});
  const std::map<std::string, std::string> options = {{"diversifications", "1"},
                                                      {"polish", "false"}};

  EXPECT_EQ(Solve("tabu", options, owned).route, Solve("tabu", options, owned).route);
}

// The list of tables 5.3 to 5.8: seeds differ, times are told, nothing else takes its place.
TEST(Tabu, OfTheThesisIsItsOwn) {
  int longer = 0;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 25});
    const std::map<std::string, std::string> options = {{"thesis", "true"},
                                                        {"diversifications", "20"}};

    const Solution found = Solve("tabu", options, owned);

    ASSERT_OK(ValidateRoute(owned.plan(), found.route));
    EXPECT_EQ(found.route, Solve("tabu", options, owned).route);
    longer += RouteCost(owned.problem, found.route) >
              RouteCost(owned.problem, Solve("greedy", {}, owned).route) + 1e-6;
  }
  EXPECT_GT(longer, 0);
  EXPECT_TRUE((*MakeStrategy("tabu", {{"thesis", "true"}}))->traits().pure);
  EXPECT_TRUE((*MakeStrategy("tabu", {{"thesis", "true"}}))->traits().serial);
}

TEST(Tabu, OfTheThesisKeepsFewerVisiblePoints) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(6, 3)));
  const Solution ours = Solve("tabu", {{"polish", "false"}, {"spacing_mm", "0.5"}}, owned);
  const Solution thesis =
      Solve("tabu", {{"thesis", "true"}, {"spacing_mm", "0.5"}, {"diversifications", "20"}}, owned);

  EXPECT_LT(thesis.statistics.at("points_vp"), ours.statistics.at("points_vp"));
  for (const char* step : {"step2_seconds", "step3_seconds", "step4_seconds"}) {
    EXPECT_GE(thesis.statistics.at(step), 0);
  }
}

TEST(Tabu, TracesTheFramework) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(2, 1)));
  const auto told = Solve("tabu", {{"trace", "true"}}, owned).statistics;

  // Paths: contour, raster, contour, raster; 4 is the origin.
  EXPECT_EQ(told.at("trace_neighbors_0_2"), 1);
  EXPECT_EQ(told.at("trace_neighbors_0_4"), 1);
  EXPECT_EQ(told.at("trace_sequence_000"), 0);
  EXPECT_EQ(told.at("trace_sequence_001"), 2);
  EXPECT_EQ(Solve("tabu", {}, owned).statistics.count("trace_sequence_000"), 0u);
}

}  // namespace
}  // namespace traverse
