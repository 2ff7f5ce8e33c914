#include "engine/strategy/tabu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <string>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/instances.h"
#include "tests/support/random_plan.h"
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

TEST(Tabu, SeedsLeadToOtherSearches) {
  OwnedProblem owned = testing::RandomProblem(
      7, {.shape = testing::PlanShape::kSequential, .min_paths = 40, .max_paths = 40});
  const std::map<std::string, std::string> options = {{"diversifications", "1"},
                                                      {"polish", "false"}};

  EXPECT_EQ(Solve("tabu", options, owned).route, Solve("tabu", options, owned).route);
}

}  // namespace
}  // namespace traverse
