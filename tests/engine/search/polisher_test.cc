#include "engine/search/polisher.h"

#include <gtest/gtest.h>

#include <chrono>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/search/iterated_search.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(Polisher, NeverReturnsAWorseRoute) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 25});
    const LayerView layer(owned.problem);
    const Route given = GivenRoute(owned.plan());
    Budget budget;
    Polisher polisher(layer, budget);
    Rng rng(seed);

    const Route descended = polisher.Descend(given, budget);
    const Route iterated = polisher.Iterate(descended, 50, rng, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), descended));
    ASSERT_OK(ValidateRoute(owned.plan(), iterated));
    const double cost = RouteCost(owned.problem, descended);
    EXPECT_LE(cost, RouteCost(owned.problem, given) + kCostTolerance);
    EXPECT_LE(RouteCost(owned.problem, iterated), cost + kCostTolerance);
  }
}

TEST(Polisher, FindsTheOptimumOfNearlyAllSmallPlans) {
  int optimal = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 7});
    const LayerView layer(owned.problem);
    Budget budget;
    Polisher polisher(layer, budget);
    Rng rng(seed);

    const Route route = polisher.Iterate(GivenRoute(owned.plan()), 100, rng, budget);

    optimal += RouteCost(owned.problem, route) <= BruteForce(owned.problem).cost + kCostTolerance;
  }
  EXPECT_GE(optimal, 90);  // nodes of fewer than four children have no kicks
}

// Than kicks alone find with the same patience.
TEST(Polisher, FindsShorterRoutesByDetours) {
  constexpr int kPatience = 100;
  double kicked_cost = 0;
  double polished_cost = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Searched s(seed, {.shape = PlanShape::kSequential, .min_paths = 60, .max_paths = 60});
    IteratedSearch kicks(s.state, s.neighbors,
                         {.local_search = {}, .patience = kPatience, .temperature = 0});
    Rng rng(seed);
    kicks.Descend(s.budget);
    kicks.Run(rng, s.budget);
    const Route kicked = s.state.Unload();
    const LayerView layer(s.owned.problem);
    Polisher polisher(layer, s.budget);

    const Route polished = polisher.Iterate(kicked, kPatience, rng, s.budget);

    kicked_cost += RouteCost(s.owned.problem, kicked);
    polished_cost += RouteCost(s.owned.problem, polished);
  }
  EXPECT_LT(polished_cost, 0.9945 * kicked_cost);
}

TEST(Polisher, OnlyChoosesEntriesWhereTheOrderIsFixed) {
  Plan plan = SequentialPlan(SquareGrid(3, 1));
  for (PlanNode& node : plan.nodes) {
    if (node.kind == PlanNode::Kind::kAnyOrder) node.kind = PlanNode::Kind::kInOrder;
  }
  const OwnedProblem owned(plan);
  const LayerView layer(owned.problem);
  Budget budget;
  Polisher polisher(layer, budget);
  Rng rng(1);

  const Route route = polisher.Iterate(GivenRoute(owned.plan()), 10, rng, budget);

  ASSERT_OK(ValidateRoute(owned.plan(), route));
  EXPECT_NEAR(RouteCost(owned.problem, route), BruteForce(owned.problem).cost, kCostTolerance);
}

TEST(Polisher, ReturnsTheRouteWhenTheBudgetHasRunOut) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(4, 4)));
  const LayerView layer(owned.problem);
  Budget late(nullptr, Budget::Clock::now() - std::chrono::seconds(1));
  Polisher polisher(layer, late);

  EXPECT_EQ(polisher.Descend(GivenRoute(owned.plan()), late), GivenRoute(owned.plan()));
}

}  // namespace
}  // namespace traverse
