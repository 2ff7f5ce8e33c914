#include "engine/search/iterated_search.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(IteratedSearch, NeverMakesARouteWorse) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 1, .max_paths = 40, .max_vertices = 12});
    IteratedSearch search(s.state, s.neighbors, {.local_search = {}, .patience = 20});
    Rng rng(seed);
    double cost = s.state.TotalCost();
    for (int i = 0; i < 5; ++i) {
      search.Run(rng, s.budget);

      EXPECT_LE(s.state.TotalCost(), cost + kCostTolerance);
      EXPECT_OK(ValidateRoute(s.owned.plan(), s.state.Unload()));
      cost = s.state.TotalCost();
    }
  }
}

TEST(IteratedSearch, EndsWithTheBestRouteHoweverFarItWalksFromIt) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 20, .max_paths = 40});
    IteratedSearch search(s.state, s.neighbors,
                          {.local_search = {}, .patience = 50, .temperature = 1000});
    Rng rng(seed);
    search.Descend(s.budget);
    const double cost = s.state.TotalCost();

    search.Run(rng, s.budget);

    EXPECT_LE(s.state.TotalCost(), cost + kCostTolerance);
    EXPECT_OK(ValidateRoute(s.owned.plan(), s.state.Unload()));
  }
}

TEST(IteratedSearch, EndsWhereIterationsGainTooLittle) {
  Searched s(7, {.min_paths = 40, .max_paths = 60});
  IteratedSearchOptions options;
  options.patience = 1'000'000;
  options.least_gain_each = 1e9;
  options.window = 30;
  IteratedSearch search(s.state, s.neighbors, options);
  Rng rng(7);
  search.Descend(s.budget);

  search.Run(rng, s.budget);

  EXPECT_EQ(search.iterations(), IteratedSearch::kLeastIterations);
}

// The iterations of a search that has gained `gained` over the order given before it begins.
int64_t IterationsFor(double gained) {
  Searched s(7, {.min_paths = 40, .max_paths = 60});
  IteratedSearchOptions options;
  options.patience = 1'000'000;
  options.least_gain_each = 1;
  options.earned = 4;
  options.window = 30;
  Budget budget;
  IteratedSearch descent(s.state, s.neighbors, options);
  descent.Descend(budget);
  options.given_cost = s.state.TotalCost() + gained;
  IteratedSearch search(s.state, s.neighbors, options);
  Rng rng(7);
  search.Run(rng, budget);
  return search.iterations();
}

TEST(IteratedSearch, GoesOnAsLongAsWhatItHasGainedIsWorth) {
  EXPECT_GE(IterationsFor(0), 30);
  EXPECT_LT(IterationsFor(0), 60);
  EXPECT_GE(IterationsFor(200), 80);
  EXPECT_LT(IterationsFor(200), 110);
}

TEST(IteratedSearch, FindsTheOptimumOfSmallProblems) {
  int optimal = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 4, .max_paths = 7});
    IteratedSearch search(s.state, s.neighbors, {.local_search = {}, .patience = 60});
    Rng rng(seed);

    search.Descend(s.budget);
    search.Run(rng, s.budget);

    optimal += s.state.TotalCost() <= BruteForce(s.owned.problem).cost + kCostTolerance;
  }
  EXPECT_GE(optimal, 180);
}

// 30 groups of as many points, far apart and in a random order: few moves are between groups, and
// the neighbors of a point are all in its group.
double CostOfGroups(uint64_t seed, double long_share) {
  Rng rng(seed);
  std::vector<Path> paths;
  for (int group = 0; group < 30; ++group) {
    const Point middle{1000 * rng.Unit(), 1000 * rng.Unit()};
    for (int i = 0; i < 30; ++i) {
      paths.push_back(MakeContour({{middle.x + 10 * rng.Unit(), middle.y + 10 * rng.Unit()}}));
    }
  }
  Searched s{OwnedProblem(AnyOrderPlan(std::move(paths)))};
  IteratedSearchOptions options;
  options.patience = 150;
  options.long_share = long_share;
  IteratedSearch search(s.state, s.neighbors, options);
  search.Descend(s.budget);
  search.Run(rng, s.budget);
  return s.state.TotalCost();
}

TEST(IteratedSearch, FindsTheOrderOfGroupsFarApartByCutsAtLongMoves) {
  double without = 0;
  double with = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    without += CostOfGroups(seed, 0);
    with += CostOfGroups(seed, 0.3);
  }
  EXPECT_LT(with, 0.995 * without) << with / without;
}

double SearchedCost(uint64_t seed, PlanShape shape, const IteratedSearchOptions& options) {
  Searched s(seed, {.shape = shape, .min_paths = 60, .max_paths = 60});
  IteratedSearch search(s.state, s.neighbors, options);
  Rng rng(seed);
  search.Descend(s.budget);
  search.Run(rng, s.budget);
  return s.state.TotalCost();
}

// Of the routes found with some options to those found with others.
double CostRatio(PlanShape shape, const IteratedSearchOptions& options,
                 const IteratedSearchOptions& others) {
  double cost = 0;
  double others_cost = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    cost += SearchedCost(seed, shape, options);
    others_cost += SearchedCost(seed, shape, others);
  }
  return cost / others_cost;
}

// Contours come first on each island: runs of islands cannot be reversed.
TEST(IteratedSearch, FindsShorterRoutesByTurningRunsOfBlocks) {
  const IteratedSearchOptions turning{.local_search = {}, .patience = 150, .turn_share = 0.5};
  const IteratedSearchOptions not_turning{.local_search = {}, .patience = 150, .turn_share = 0};
  EXPECT_LT(CostRatio(PlanShape::kInterleaved, turning, not_turning), 0.985);
}

TEST(IteratedSearch, FindsShorterRoutesByWalkingAmongWorseOnes) {
  const IteratedSearchOptions walking{.local_search = {}, .patience = 500, .bridges = 5};
  const IteratedSearchOptions not_walking{
      .local_search = {}, .patience = 500, .temperature = 0, .bridges = 5};
  EXPECT_LT(CostRatio(PlanShape::kSequential, walking, not_walking), 0.999);
}

TEST(IteratedSearch, FindsShorterRoutesByCheaperKicks) {
  const IteratedSearchOptions choosing{.local_search = {}, .patience = 100, .bridges = 4};
  const IteratedSearchOptions not_choosing{.local_search = {}, .patience = 100, .bridges = 1};
  EXPECT_LT(CostRatio(PlanShape::kFlatContours, choosing, not_choosing), 0.998);
}

TEST(IteratedSearch, StopsWhenPatienceIsOut) {
  Searched s(1, {.shape = PlanShape::kFlatContours, .min_paths = 6, .max_paths = 6});
  IteratedSearch search(s.state, s.neighbors, {.local_search = {}, .patience = 7});
  Rng rng(1);
  search.Run(rng, s.budget);
  const int64_t before = search.iterations();

  search.Run(rng, s.budget);

  EXPECT_EQ(search.iterations() - before, 7);
}

}  // namespace
}  // namespace traverse
