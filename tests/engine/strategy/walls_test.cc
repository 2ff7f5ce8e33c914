// What every strategy promises, in layers with walls.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/bounds/lower_bound.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/walled_problem.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

class StrategyAmongWalls : public ::testing::TestWithParam<std::string> {
 protected:
  Solution Solve(const LayerProblem& problem) {
    Budget budget;
    return (*MakeStrategy(GetParam(), {}))->Solve(problem, budget);
  }
};

double BruteForceCost(const WalledProblem& walled) {
  return BruteForce(walled.problem(),
                    [&](Point from, Point to) { return WalledMoveCost(walled, from, to); })
      .cost;
}

TEST_P(StrategyAmongWalls, IsBetweenTheOptimumAndTheOrderGiven) {
  int optimal = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled =
        RandomWalledProblem(seed, {.min_paths = 1, .max_paths = 6, .special = false});
    const LayerProblem& problem = walled.problem();

    const Solution solution = Solve(problem);

    ASSERT_OK(ValidateRoute(*problem.plan, solution.route));
    const double cost = RouteCost(problem, solution.route);
    const double optimum = BruteForceCost(walled);
    EXPECT_GE(cost, optimum - kCostTolerance);
    EXPECT_LE(cost, RouteCost(problem, GivenRoute(*problem.plan)) + kCostTolerance);
    if (solution.lower_bound) {
      EXPECT_LE(*solution.lower_bound, optimum + kCostTolerance);
    }
    if (solution.stop == StopReason::kOptimal) {
      EXPECT_LE(cost, optimum + kCostTolerance);
    }
    optimal += cost <= optimum + kCostTolerance ? 1 : 0;
  }
  if (GetParam() == "exact") {
    EXPECT_EQ(optimal, 100);
  }
  if (GetParam() == "auto") {
    EXPECT_GE(optimal, 95);
  }
}

TEST_P(StrategyAmongWalls, FindsRoutesAroundWallsNotBehindGreedy) {
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled =
        RandomWalledProblem(seed, {.min_paths = 10, .max_paths = 30}, true);
    const LayerProblem& problem = walled.problem();
    Budget budget = Budget().Within(std::chrono::milliseconds(500));

    const Solution solution = (*MakeStrategy(GetParam(), {}))->Solve(problem, budget);

    ASSERT_OK(ValidateRoute(*problem.plan, solution.route));
    if (GetParam() == "none") continue;
    Budget greedy_budget;
    const Route greedy = (*MakeStrategy("greedy", {}))->Solve(problem, greedy_budget).route;
    EXPECT_LE(RouteCost(problem, solution.route), RouteCost(problem, greedy) + kCostTolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(All, StrategyAmongWalls,
                         ::testing::Values("none", "greedy", "ni2opt", "tabu", "exact", "auto"));

TEST(LowerBound, StaysBelowTheOptimumAmongWalls) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled =
        RandomWalledProblem(seed, {.min_paths = 1, .max_paths = 6, .special = false});
    Budget budget;

    const auto bound = LowerBound(walled.problem(), 1e9, nullptr, 1, budget);

    ASSERT_TRUE(bound.has_value());
    EXPECT_LE(*bound, BruteForceCost(walled) + kCostTolerance);
  }
}

// Two rows of pieces on either side of a wall, given in zigzag: by length, it is a step from one
// row to the other.
TEST(Auto, CrossesAWallAsOftenAsItMust) {
  std::vector<Path> paths;
  for (int i = 0; i < 40; ++i) {
    paths.push_back(MakeContour({{4.0 * i, 0}}));
    paths.push_back(MakeContour({{4.0 * i, 3}}));
  }
  OwnedProblem owned(AnyOrderPlan(std::move(paths)));
  owned.problem.cost.kind = CostSpec::Kind::kTime;
  owned.problem.cost.speed_mm_s = 100;
  owned.problem.cost.retraction_seconds = 1;
  owned.problem.cost.retraction_threshold_mm = 1000;
  const LayerWalls walls{{{{{-10, 1.5}, {200, 1.5}}, false, -1}}, {}};
  const WallCost cost(walls, owned.plan(), owned.problem.cost);
  owned.problem.walls = &cost;
  Budget budget;

  const Solution solution = (*MakeStrategy("auto", {}))->Solve(owned.problem, budget);

  EXPECT_NEAR(RouteCost(owned.problem, solution.route), 1 + (156 + 3 + 156) / 100.0, 1e-9);
}

}  // namespace
}  // namespace traverse
