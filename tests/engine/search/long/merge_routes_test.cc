#include "engine/search/long/merge_routes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/search/iterated_search.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/problems/instances.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// Path i is a point at (i, 0), and the head begins at (-1, 0): 0, 1, 2, ... is the shortest route.
Route InOrder(const std::vector<int>& paths) {
  Route route;
  for (const int path : paths) route.push_back({path, 0});
  return route;
}

Route Merged(const OwnedProblem& owned, const Route& other, Route route) {
  Budget budget;
  MergeRoutes(owned.problem, other, route, budget);
  return route;
}

TEST(MergeRoutes, TakesTheBetterStretchesOfBoth) {
  const OwnedProblem owned(FlatPlan(8), {-1, 0});
  const Route one = InOrder({0, 2, 1, 3, 4, 5, 6, 7});
  const Route other = InOrder({0, 1, 2, 3, 4, 6, 5, 7});

  EXPECT_EQ(Merged(owned, other, one), InOrder({0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(Merged(owned, one, other), InOrder({0, 1, 2, 3, 4, 5, 6, 7}));
}

// The other route is so much longer at its end that only a part of it is of use.
TEST(MergeRoutes, TakesAStretchBackwards) {
  const OwnedProblem owned(FlatPlan(9), {-1, 0});
  const Route one = InOrder({0, 3, 1, 2, 4, 5, 6, 7, 8});
  const Route other = InOrder({0, 4, 3, 2, 1, 8, 5, 7, 6});

  EXPECT_EQ(Merged(owned, other, one), InOrder({0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(MergeRoutes, TurnsOpenPathsWithTheStretch) {
  std::vector<Path> paths;
  for (int i = 0; i < 4; ++i) paths.push_back(MakeOpenPath({2.0 * i, 0}, {2.0 * i + 1, 0}));
  const OwnedProblem owned(AnyOrderPlan(std::move(paths)), {-1, 0});
  const Route one = {{0, 0}, {2, 0}, {1, 0}, {3, 0}};
  const Route other = {{3, 1}, {2, 1}, {1, 1}, {0, 0}};

  EXPECT_EQ(Merged(owned, other, one), (Route{{0, 0}, {1, 0}, {2, 0}, {3, 0}}));
}

TEST(MergeRoutes, KeepsToThePlan) {
  Plan plan = FlatPlan(6);
  plan.nodes[0].before = {{3, 1}};
  const OwnedProblem owned(plan, {-1, 0});
  const Route one = InOrder({0, 3, 2, 1, 5, 4});
  const Route other = InOrder({5, 4, 0, 3, 2, 1});  // 3, 2, 1 would be shorter backwards

  const Route merged = Merged(owned, other, one);

  ASSERT_OK(ValidateRoute(owned.plan(), merged));
  EXPECT_EQ(merged, InOrder({0, 3, 2, 1, 4, 5}));
}

// A local optimum from somewhere else than the given order.
Route Shaken(Searched& s, Rng& rng) {
  IteratedSearch search(s.state, s.neighbors, {.local_search = {}, .patience = 10});
  search.Shake(5, rng, s.budget);
  return s.state.Unload();
}

TEST(MergeRoutes, IsNeverLongerThanEither) {
  int better = 0;
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 2, .max_paths = 60});
    Rng rng(seed);
    const Route one = Shaken(s, rng);
    const Route other = Shaken(s, rng);
    const LayerProblem& problem = s.owned.problem;

    Route merged = one;
    MergeRoutes(problem, other, merged, s.budget);

    ASSERT_OK(ValidateRoute(s.owned.plan(), merged));
    const double least = std::min(RouteCost(problem, one), RouteCost(problem, other));
    EXPECT_LE(RouteCost(problem, merged), least + kCostTolerance);
    better += RouteCost(problem, merged) < least - kCostTolerance;
  }
  EXPECT_GE(better, 30);
}

TEST(MergeRoutes, ReturnsARouteAlsoWithoutTime) {
  const OwnedProblem owned(FlatPlan(4), {-1, 0});
  Budget budget(nullptr, Budget::Clock::time_point::min());
  Route route = InOrder({3, 2, 1, 0});

  MergeRoutes(owned.problem, InOrder({0, 2, 1, 3}), route, budget);

  EXPECT_EQ(route, InOrder({0, 2, 1, 3}));
}

}  // namespace
}  // namespace traverse
