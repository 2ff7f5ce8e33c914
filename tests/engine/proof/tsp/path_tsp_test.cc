#include "engine/proof/tsp/path_tsp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/model/point.h"
#include "engine/proof/min_plus.h"
#include "tests/engine/proof/tsp/small_tsp.h"

namespace traverse {
namespace {

TEST(PathTspSolver, FindsTheBestPath) {
  for (uint64_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const SmallTsp instance = RandomTsp(seed, static_cast<int>(2 + seed % 5));
    const double best = BestTspCost(instance);
    PathTspSolver solver(instance.tsp);
    Budget budget;

    EXPECT_LE(solver.RootBound(instance.start, 2 * best + 1, budget), best + 1e-7);
    const PathTspSolver::Result result = solver.Solve(instance.start, 2 * best + 1, {}, budget);

    EXPECT_TRUE(result.complete);
    ASSERT_FALSE(result.path.empty());
    EXPECT_NEAR(result.cost, best, 1e-9 * (1 + best));
    EXPECT_NEAR(TspCostOf(instance, result.path), result.cost, 1e-9 * (1 + best));
    EXPECT_NEAR(result.lower_bound, best, 1e-6 * (1 + best));
  }
}

TEST(PathTspSolver, FindsNothingBelowTheBestPath) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const SmallTsp instance = RandomTsp(seed, 5);
    const double best = BestTspCost(instance);
    PathTspSolver solver(instance.tsp);
    Budget budget;

    const PathTspSolver::Result result =
        solver.Solve(instance.start, best * (1 - 1e-7), {}, budget);

    EXPECT_TRUE(result.complete);
    EXPECT_TRUE(result.path.empty());
    EXPECT_GE(result.lower_bound, best * (1 - 1e-7));
  }
}

// What was learned for one start must not spoil another one.
TEST(PathTspSolver, IsAskedAgainWithOtherStarts) {
  SmallTsp instance = RandomTsp(7, 6);
  PathTspSolver solver(instance.tsp);
  Budget budget;
  Rng rng(1);
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(absl::StrCat("round ", round));
    for (double& start : instance.start) start = rng.Below(3) == 0 ? kUnreached : 200 * rng.Unit();
    instance.start[0] = 100;
    const double best = BestTspCost(instance);

    const PathTspSolver::Result result =
        solver.Solve(instance.start, best + 20 * rng.Unit() + 1e-3, {}, budget);

    EXPECT_TRUE(result.complete);
    EXPECT_NEAR(result.cost, best, 1e-9 * (1 + best));
  }
}

// Clusters of five points in the plane, as GTSPLIB has them.
SmallTsp Clusters(int count) {
  Rng rng(5);
  SmallTsp instance;
  PathTsp& tsp = instance.tsp;
  std::vector<Point> points;
  for (int item = 0; item < count; ++item) {
    const Point middle{100 * rng.Unit(), 100 * rng.Unit()};
    for (int i = 0; i < 5; ++i) {
      tsp.item.push_back(item);
      tsp.mate.push_back(static_cast<int>(points.size()));
      points.push_back({middle.x + 20 * rng.Unit(), middle.y + 20 * rng.Unit()});
    }
  }
  tsp.ports = static_cast<int>(points.size());
  for (const Point& p : points) {
    for (const Point& q : points) tsp.cost.push_back(Distance(p, q));
    tsp.finish.push_back(0);
    instance.start.push_back(Distance(p, {0, 0}));
  }
  return instance;
}

// They are within reach at once; walks of half as much at each of two points of a cluster are what
// generalised subtours forbid.
TEST(PathTspSolver, ProvesClustersOfPoints) {
  const SmallTsp instance = Clusters(30);
  const double given = TspCostOf(instance, FirstPorts(instance.tsp));
  PathTspSolver solver(instance.tsp);
  Budget budget;

  const PathTspSolver::Result result = solver.Solve(instance.start, given, {}, budget);
  const double root = PathTspSolver(instance.tsp).RootBound(instance.start, given, budget);

  EXPECT_TRUE(result.complete);
  EXPECT_NEAR(result.lower_bound, result.cost, 1e-6 * result.cost);
  EXPECT_NEAR(TspCostOf(instance, result.path), result.cost, 1e-9 * result.cost);
  EXPECT_GT(root, 0.97 * result.cost);
}

// Branching on which clusters follow each other leaves nothing behind for another start.
TEST(PathTspSolver, ProvesClustersFromSeveralStarts) {
  SmallTsp instance = Clusters(30);
  PathTspSolver solver(instance.tsp);
  Budget budget;
  for (const double x : {0.0, 100.0}) {
    SCOPED_TRACE(x);
    for (size_t p = 0; p < instance.start.size(); ++p) {
      instance.start[p] = std::abs(instance.tsp.cost[p] - x);
    }
    const double given = TspCostOf(instance, FirstPorts(instance.tsp));

    const PathTspSolver::Result result = solver.Solve(instance.start, given, {}, budget);
    const PathTspSolver::Result afresh =
        PathTspSolver(instance.tsp).Solve(instance.start, given, {}, budget);

    EXPECT_TRUE(result.complete);
    EXPECT_TRUE(afresh.complete);
    EXPECT_NEAR(result.cost, afresh.cost, 1e-6 * result.cost);
    EXPECT_NEAR(TspCostOf(instance, result.path), result.cost, 1e-9 * result.cost);
  }
  EXPECT_GT(solver.nodes(), 3);
}

// A node whose programme is not solved stays open, and the others are done all the same.
TEST(PathTspSolver, GoesOnAfterANodeThatFails) {
  const SmallTsp instance = Clusters(24);
  const double given = TspCostOf(instance, FirstPorts(instance.tsp));
  Budget budget;
  const PathTspSolver::Result best =
      PathTspSolver(instance.tsp).Solve(instance.start, given, {}, budget);
  ASSERT_TRUE(best.complete);
  const double root =
      PathTspSolver(instance.tsp).RootBound(instance.start, best.cost * 1.01, budget);
  int failed = 0;
  for (const int most_iterations : {1, 25}) {
    SCOPED_TRACE(most_iterations);
    PathTspSolver solver(instance.tsp, most_iterations);
    const PathTspSolver::Result result = solver.Solve(instance.start, best.cost * 1.01, {}, budget);

    EXPECT_LE(result.lower_bound, best.cost * (1 + 1e-9));
    EXPECT_GE(result.lower_bound, root * (1 - 1e-9));
    if (result.complete) {
      EXPECT_GE(result.lower_bound, best.cost * (1 - 1e-9));
    }
    if (!result.complete && solver.nodes() > 4) ++failed;
  }
  EXPECT_GT(failed, 0);
}

TEST(PathTspSolver, BoundsWhatItCannotSolveInTime) {
  const SmallTsp instance = RandomTsp(3, 120);
  const std::vector<int> known = FirstPorts(instance.tsp);
  const double given = TspCostOf(instance, known);
  PathTspSolver solver(instance.tsp);
  CancelToken cancel;
  cancel.Cancel();
  Budget cancelled(&cancel);

  const PathTspSolver::Result result = solver.Solve(instance.start, given, known, cancelled);

  EXPECT_FALSE(result.complete);
  EXPECT_LE(result.lower_bound, given);
}

}  // namespace
}  // namespace traverse
