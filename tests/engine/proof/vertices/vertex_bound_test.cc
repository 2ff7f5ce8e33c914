#include "engine/proof/vertices/vertex_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
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

// Each near pair is measured before the first ask.
TEST(VertexBound, LeavesManyEndsOfManyPointsToTrees) {
  for (const auto& [contours, points, fits] :
       {std::tuple(1100, 40, false), std::tuple(1100, 20, true), std::tuple(900, 40, true)}) {
    const Plan plan = ScatteredPlan(contours, points);
    EXPECT_EQ(VertexBound::Fits(EndGraph(PlanTree(plan))), fits) << contours << " of " << points;
  }
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

TEST(VertexBound, DoesMoreWorkWhileItIsFarFromTheTarget) {
  const OwnedProblem owned(testing::ClusterPlan(60));
  Budget budget;
  const auto search = [&](double target, double& work) {
    TreeBound tree(owned.problem, budget);
    EXPECT_TRUE(tree.Evaluate(budget));
    VertexBound bound(owned.problem, tree);
    const double found =
        bound.Search(target, {.rounds = 40, .work = 3e6, .work_while_far = 2e7}, budget);
    work = bound.work();
    return found;
  };
  double far = 0;
  double near = 0;

  const double found = search(RouteCost(owned.problem, GivenRoute(owned.plan())), far);
  search(1.1 * found, near);

  EXPECT_GT(far, 1.9e7);
  EXPECT_LT(near, 1.5e7);
}

TEST(VertexBound, TakesLayersOfManyEnds) {
  const OwnedProblem owned(testing::ClusterPlan(1100));
  const double cost = RouteCost(owned.problem, GivenRoute(owned.plan()));
  Budget budget;
  TreeBound tree(owned.problem, budget);
  ASSERT_TRUE(tree.Evaluate(budget));
  tree.Ascend(0.05 * cost, 40, budget);
  ASSERT_TRUE(tree.Evaluate(budget));

  ASSERT_TRUE(VertexBound::Fits(tree.graph()));
  EXPECT_GT(VertexBound(owned.problem, tree).Search(0.05 * cost, {.rounds = 4}, budget),
            1.2 * tree.lower_bound());
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
