#include "engine/proof/vertices/vertex_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
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

    EXPECT_LE(bound.Search(target, {.rounds = 2}, budget), best + 1e-9 * (1 + best));
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
    bounds.push_back(bound.Search(cost, {.rounds = rounds}, budget));
  }

  EXPECT_GE(bounds[0], 0);
  EXPECT_GT(bounds[2], 1.2 * of_tree);
  EXPECT_TRUE(std::is_sorted(bounds.begin(), bounds.end()));
}

// No box rules out a pair of such contours, and all of their places are worth splitting.
Plan ScatteredPlan(int contours, int points_each) {
  Rng rng(7);
  std::vector<Path> paths;
  for (int i = 0; i < contours; ++i) {
    std::vector<Point> points;
    for (int k = 0; k < points_each; ++k) points.push_back({200 * rng.Unit(), 200 * rng.Unit()});
    paths.push_back(MakeContour(std::move(points)));
  }
  return testing::AnyOrderPlan(std::move(paths));
}

TEST(VertexBound, EndsWithItsWorkAndKeepsWhatItFound) {
  const OwnedProblem owned(testing::ClusterPlan(60));
  const double cost = RouteCost(owned.problem, GivenRoute(owned.plan()));
  Budget budget;
  std::vector<double> bounds;

  for (const double work : {0.0, 1e6, 1e7, 5e7}) {
    TreeBound tree(owned.problem, budget);
    ASSERT_TRUE(tree.Evaluate(budget));
    VertexBound bound(owned.problem, tree);
    bounds.push_back(bound.Search(cost, {.rounds = 40, .work = work}, budget));
    EXPECT_LT(bound.work(), work + 3e6);
  }

  EXPECT_EQ(bounds[0], 0);
  EXPECT_GT(bounds[1], 0);
  EXPECT_GT(bounds[2], 1.1 * bounds[1]);
  EXPECT_TRUE(std::is_sorted(bounds.begin(), bounds.end()));
}

TEST(VertexBound, EndsWithItsWorkWhereNothingIsRuledOut) {
  const OwnedProblem owned(ScatteredPlan(60, 200));
  const double cost = RouteCost(owned.problem, GivenRoute(owned.plan()));
  Budget budget;
  TreeBound tree(owned.problem, budget);
  ASSERT_TRUE(tree.Evaluate(budget));
  VertexBound bound(owned.problem, tree);
  const double begun = bound.work();

  bound.Search(cost, {.rounds = 8, .work = begun + 1e7}, budget);

  EXPECT_GT(begun, 1e6);  // the distances of the first near pairs
  EXPECT_LT(bound.work(), begun + 6e7);
}

TEST(VertexBound, IsNothingWithoutTime) {
  const OwnedProblem owned(testing::ClusterPlan(40));
  Budget budget;
  TreeBound tree(owned.problem, budget);
  VertexBound bound(owned.problem, tree);
  CancelToken cancel;
  cancel.Cancel();
  Budget cancelled(&cancel);

  EXPECT_EQ(bound.Search(1e6, {.rounds = 2}, cancelled), 0);
}

}  // namespace
}  // namespace traverse
