#include "engine/cost/route_entries.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/entry_choice.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(ChooseEntries, IsExactForOneWindow) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 30});
    const LayerView layer(owned.problem);
    Route route = GivenRoute(owned.plan());
    std::vector<int> order;
    for (const Visit& visit : route) order.push_back(visit.path);
    std::vector<int> entries(order.size());
    const double least =
        EntryChoice(layer.table, layer.cost)
            .Choose(owned.problem.start, order, owned.problem.finish, absl::MakeSpan(entries));
    Budget budget;

    ChooseEntries(layer, route, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), route));
    EXPECT_NEAR(RouteCost(owned.problem, route), least, kCostTolerance);
    for (size_t k = 0; k < route.size(); ++k) EXPECT_EQ(route[k].path, order[k]);
  }
}

TEST(ChooseEntries, NeverMakesALongRouteWorse) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(20, 20)));  // 800 visits
  const LayerView layer(owned.problem);
  Route route = GivenRoute(owned.plan());
  const double given = RouteCost(owned.problem, route);
  Budget budget;

  ChooseEntries(layer, route, budget);
  const double once = RouteCost(owned.problem, route);
  ChooseEntries(layer, route, budget);

  ASSERT_OK(ValidateRoute(owned.plan(), route));
  EXPECT_LT(once, given);
  EXPECT_LE(RouteCost(owned.problem, route), once + kCostTolerance);
}

TEST(ChooseEntries, LeavesTheRouteWhenTheBudgetHasRunOut) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(3, 3)));
  const LayerView layer(owned.problem);
  Route route = GivenRoute(owned.plan());
  Budget late(nullptr, Budget::Clock::now() - std::chrono::seconds(1));

  ChooseEntries(layer, route, late);

  EXPECT_EQ(route, GivenRoute(owned.plan()));
}

}  // namespace
}  // namespace traverse
