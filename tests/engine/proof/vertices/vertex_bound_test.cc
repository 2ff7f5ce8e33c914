#include "engine/proof/vertices/vertex_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/trees/tree_bound.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

// Targets above the optimum make steps too long: what goes wrong is then not hidden by the target.
TEST(VertexBound, IsNeverAboveTheOptimum) {
  int fits = 0;
  for (uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.min_paths = 2, .max_paths = 6});
    Budget budget;
    TreeBound tree(owned.problem, budget);
    if (!VertexBound::Fits(tree.graph())) continue;
    ++fits;
    const double best = testing::BruteForce(owned.problem).cost;
    const double target = best * (1 + static_cast<double>(seed % 4)) + 1;
    VertexBound bound(owned.problem, tree);

    EXPECT_LE(bound.Search(target, 2, budget), best + 1e-9 * (1 + best));
  }
  EXPECT_GT(fits, 200);
}

TEST(VertexBound, IsFarAboveTreesAndNeverLowerAfterMoreRounds) {
  const OwnedProblem owned(testing::ClusterPlan(40));
  const double cost = RouteCost(owned.problem, GivenRoute(owned.plan()));
  Budget budget;
  double of_tree = 0;
  std::vector<double> bounds;

  for (const int rounds : {0, 1, 2, 4, 8}) {
    TreeBound tree(owned.problem, budget);
    ASSERT_TRUE(tree.Evaluate(budget));
    tree.Ascend(cost, 40, budget);
    ASSERT_TRUE(tree.Evaluate(budget));
    of_tree = tree.lower_bound();
    VertexBound bound(owned.problem, tree);
    bounds.push_back(bound.Search(cost, rounds, budget));
  }

  EXPECT_GE(bounds[0], 0);
  EXPECT_GT(bounds[2], 1.2 * of_tree);
  EXPECT_TRUE(std::is_sorted(bounds.begin(), bounds.end()));
}

TEST(VertexBound, IsNothingWithoutTime) {
  const OwnedProblem owned(testing::ClusterPlan(40));
  Budget budget;
  TreeBound tree(owned.problem, budget);
  VertexBound bound(owned.problem, tree);
  CancelToken cancel;
  cancel.Cancel();
  Budget cancelled(&cancel);

  EXPECT_EQ(bound.Search(1e6, 2, cancelled), 0);
}

}  // namespace
}  // namespace traverse
