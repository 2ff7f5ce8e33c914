#include "engine/search/long/long_search.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

LongSearchOptions ShortWalks() {
  LongSearchOptions options;
  options.walk.patience = 40;
  options.patience = 200;
  return options;
}

TEST(LongSearch, NeverMakesARouteWorse) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 1, .max_paths = 30});
    Rng rng(seed);
    double cost = s.state.TotalCost();
    for (int i = 0; i < 2; ++i) {
      SearchLong(s.owned.problem, s.state, s.neighbors, ShortWalks(), rng, s.budget);

      EXPECT_LE(s.state.TotalCost(), cost + kCostTolerance);
      EXPECT_OK(ValidateRoute(s.owned.plan(), s.state.Unload()));
      cost = s.state.TotalCost();
    }
  }
}

TEST(LongSearch, EndsWhenPatienceIsOut) {
  Searched s(1, {.shape = PlanShape::kFlatContours, .min_paths = 6, .max_paths = 6});
  Rng rng(1);
  SearchLong(s.owned.problem, s.state, s.neighbors, ShortWalks(), rng, s.budget);

  const int64_t more =
      SearchLong(s.owned.problem, s.state, s.neighbors, ShortWalks(), rng, s.budget);

  EXPECT_GE(more, 200);
  EXPECT_LE(more, 400);  // the last walk ends by itself
}

TEST(LongSearch, KeepsTheRouteWhereThereIsNoTime) {
  Searched s(3, {.min_paths = 40, .max_paths = 40});
  const Route route = s.state.Unload();
  Budget budget(nullptr, Budget::Clock::time_point::min());
  Rng rng(1);

  SearchLong(s.owned.problem, s.state, s.neighbors, ShortWalks(), rng, budget);

  EXPECT_EQ(s.state.Unload(), route);
}

// Than one walk of at least as many iterations finds.
TEST(LongSearch, FindsAShorterRouteThanOneWalk) {
  const RandomPlanOptions shape{
      .shape = PlanShape::kFlatContours, .min_paths = 80, .max_paths = 80};
  Searched many(1, shape);
  LongSearchOptions options;
  options.walk.patience = 100;
  options.patience = 1500;
  Rng rng(1);
  IteratedSearch(many.state, many.neighbors, options.walk).Descend(many.budget);
  const int64_t iterations =
      SearchLong(many.owned.problem, many.state, many.neighbors, options, rng, many.budget);

  Searched one(1, shape);
  options.walk.patience = iterations;
  IteratedSearch walk(one.state, one.neighbors, options.walk);
  walk.Descend(one.budget);
  walk.Run(rng, one.budget);

  EXPECT_LT(many.state.TotalCost(), one.state.TotalCost());
}

}  // namespace
}  // namespace traverse
