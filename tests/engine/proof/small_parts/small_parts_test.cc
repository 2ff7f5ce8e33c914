#include "engine/proof/small_parts/small_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

TEST(SmallParts, IsTheOptimumOfASmallPlan) {
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 7});
    const double best = testing::BruteForce(owned.problem).cost;
    const LayerView layer(owned.problem);
    Route route = GivenRoute(owned.plan());
    Budget budget;

    EXPECT_TRUE(SolveSmallParts(layer, {}, route, budget));

    ASSERT_OK(ValidateRoute(owned.plan(), route));
    EXPECT_NEAR(RouteCost(owned.problem, route), best, 1e-6 * (1 + best));
  }
}

// A plan too large as a whole.
TEST(SmallParts, ImprovesThePartsOfALargePlan) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        testing::RandomProblem(seed, {.min_paths = 20, .max_paths = 40, .max_vertices = 8});
    const LayerView layer(owned.problem);
    Budget budget;
    Route route = GivenRoute(owned.plan());
    const double given = RouteCost(owned.problem, route);

    SolveSmallParts(layer, {.most_operations = 2e4}, route, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), route));
    const double cost = RouteCost(owned.problem, route);
    EXPECT_LE(cost, given + 1e-9);
    SolveSmallParts(layer, {.most_operations = 2e4}, route, budget);
    EXPECT_LE(RouteCost(owned.problem, route), cost + 1e-9);
  }
}

// Twelve islands, each a part of its own: within each, outline and raster.
TEST(SmallParts, SolvesEachIslandOfManyIslands) {
  const OwnedProblem owned(InterleavedPlan(testing::SquareGrid(7, 3)));
  const LayerView layer(owned.problem);
  Route route = GivenRoute(owned.plan());
  const double given = RouteCost(owned.problem, route);
  Budget budget;

  EXPECT_FALSE(SolveSmallParts(layer, {}, route, budget));

  EXPECT_LT(RouteCost(owned.problem, route), given - 1);
}

TEST(SmallParts, LeavesTheRouteWhenTheBudgetIsOver) {
  const OwnedProblem owned(testing::FlatPlan(8));
  const LayerView layer(owned.problem);
  Route route = GivenRoute(owned.plan());
  std::reverse(route.begin(), route.end());
  const Route before = route;
  CancelToken cancel;
  cancel.Cancel();
  Budget budget(&cancel);

  EXPECT_FALSE(SolveSmallParts(layer, {}, route, budget));
  EXPECT_EQ(route, before);
}

// n single points: from the start to each of them, and from each subset's last one to another.
TEST(IsSmall, CountsTheStepsOfAllSubsets) {
  for (int n = 2; n <= 9; ++n) {
    const OwnedProblem owned(testing::FlatPlan(n));
    const LayerView layer(owned.problem);
    const double steps = n + n * (n - 1) * std::exp2(n - 2);

    EXPECT_TRUE(IsSmall(layer, {.most_operations = steps})) << n;
    EXPECT_FALSE(IsSmall(layer, {.most_operations = steps - 1})) << n;
  }
}

TEST(IsSmall, LimitsTheChildrenOfANode) {
  const OwnedProblem owned(testing::FlatPlan(5));
  const LayerView layer(owned.problem);

  EXPECT_TRUE(IsSmall(layer, {.most_children = 5}));
  EXPECT_FALSE(IsSmall(layer, {.most_children = 4}));
}

}  // namespace
}  // namespace traverse
