#include "engine/proof/trees/tree_bound.h"

#include <gtest/gtest.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

// Whatever is paid at the ends: that is where bounds of this kind go wrong.
TEST(TreeBound, IsNeverAboveTheOptimumAtAnyMultipliers) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 6});
    if (owned.plan().paths.empty()) continue;
    const double best = testing::BruteForce(owned.problem).cost;
    Rng rng(seed);
    Budget budget;
    TreeBound bound(owned.problem, budget);
    EXPECT_EQ(bound.lower_bound(), 0);
    for (int round = 0; round < 5; ++round) {
      std::vector<double> multipliers(bound.multipliers().size());
      for (double& multiplier : multipliers) multiplier = best * (rng.Unit() - 0.5);
      bound.SetMultipliers(multipliers);

      ASSERT_TRUE(bound.Evaluate(budget));

      EXPECT_LE(bound.lower_bound(), best + 1e-9 * (1 + best));
    }
  }
}

TEST(TreeBound, RisesInAnAscentAndKeepsItsBest) {
  int higher = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 6});
    if (owned.plan().paths.empty()) continue;
    const double best = testing::BruteForce(owned.problem).cost;
    Budget budget;
    TreeBound bound(owned.problem, budget);
    ASSERT_TRUE(bound.Evaluate(budget));
    const double before = bound.lower_bound();

    bound.Ascend(best, 50, budget);
    ASSERT_TRUE(bound.Evaluate(budget));

    const double after = bound.lower_bound();
    EXPECT_GE(after, before);
    EXPECT_LE(after, best + 1e-9 * (1 + best));
    higher += after > before + 1e-6 ? 1 : 0;
    const std::vector<double> multipliers = bound.multipliers();
    bound.SetMultipliers(std::vector<double>(multipliers.size(), best));
    ASSERT_TRUE(bound.Evaluate(budget));
    EXPECT_EQ(bound.lower_bound(), after);
    EXPECT_EQ(bound.multipliers(), multipliers);
  }
  EXPECT_GT(higher, 30);
}

TEST(TreeBound, SaysNothingWhereItsBudgetIsUsedUp) {
  const OwnedProblem owned = testing::RandomProblem(3, {.max_paths = 6});
  ASSERT_FALSE(owned.plan().paths.empty());
  Budget plenty;
  TreeBound bound(owned.problem, plenty);
  CancelToken cancelled;
  cancelled.Cancel();
  Budget budget(&cancelled);

  EXPECT_FALSE(bound.Evaluate(budget));
  EXPECT_EQ(bound.lower_bound(), 0);
}

}  // namespace
}  // namespace traverse
