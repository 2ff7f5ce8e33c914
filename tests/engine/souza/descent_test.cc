#include "engine/souza/descent.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(Descent, IsValidAndItsChangeIsThatOfTheCost) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 40});
    const LayerView layer(owned.problem);
    for (const bool point_release : {false, true}) {
      SearchRoute route(layer, GivenRoute(owned.plan()));
      const double before = route.Cost();
      Budget budget;

      const double change = Descend(route, {point_release}, budget);

      EXPECT_LE(change, 0);
      EXPECT_NEAR(route.Cost(), before + change, kCostTolerance * std::max(1.0, before));
      ASSERT_OK(ValidateRoute(owned.plan(), route.ToRoute()));
    }
  }
}

TEST(Descent, WithoutPointReleaseKeepsTheEntriesOfContours) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 20});
    Budget budget;

    const Route route =
        Improve(LayerView(owned.problem), GivenRoute(owned.plan()), {false}, budget);

    for (const Visit& visit : route) {
      const Path& path = owned.plan().paths[static_cast<size_t>(visit.path)];
      EXPECT_TRUE(path.kind == Path::Kind::kOpen || visit.entry == GivenEntry(path));
    }
  }
}

TEST(Descent, IsNoBetterThanTheOptimumAndOftenReachesIt) {
  int optimal = 0;
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 6});
    const double optimum = BruteForce(owned.problem).cost;
    Budget budget;

    const Route route = Improve(LayerView(owned.problem), GivenRoute(owned.plan()), {}, budget);

    EXPECT_GE(RouteCost(owned.problem, route), optimum - kCostTolerance);
    optimal += RouteCost(owned.problem, route) < optimum + kCostTolerance;
  }
  EXPECT_GE(optimal, 150);
}

// Two islands that were done in the wrong order; inside each, the raster is free to turn.
TEST(Descent, MovesWholeIslands) {
  const OwnedProblem owned(InterleavedPlan(SquareGrid(4, 1)), {20, 0});
  Budget budget;

  const Route route = Improve(LayerView(owned.problem), GivenRoute(owned.plan()), {}, budget);

  EXPECT_EQ(route.front().path, 6);
  EXPECT_EQ(route.back().path, 1);
  EXPECT_EQ(route.back().entry, 1);
}

TEST(Descent, StopsAtOnceWhenCancelled) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(30, 30)));
  CancelToken cancelled;
  cancelled.Cancel();
  Budget budget(&cancelled);

  EXPECT_EQ(Improve(LayerView(owned.problem), GivenRoute(owned.plan()), {}, budget),
            GivenRoute(owned.plan()));
}

}  // namespace
}  // namespace traverse
