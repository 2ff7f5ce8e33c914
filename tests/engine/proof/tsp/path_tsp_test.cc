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

namespace traverse {
namespace {

struct Instance {
  PathTsp tsp;
  std::vector<double> start;
};

// `items` with one end, with two, or with a choice of up to three ports in a square of side 100,
// some on a grid, so that there are ties.
Instance RandomInstance(uint64_t seed, int items) {
  Rng rng(seed);
  const bool grid = rng.Below(3) == 0;
  const auto coordinate = [&] { return grid ? 10.0 * rng.Below(5) : 100 * rng.Unit(); };
  std::vector<Point> ends;
  Instance instance;
  PathTsp& tsp = instance.tsp;
  for (int i = 0; i < items; ++i) {
    const int port = static_cast<int>(ends.size());
    const bool two_ends = rng.Below(3) != 0;
    const int ports = two_ends ? 2 : rng.Between(1, 3);
    for (int p = 0; p < ports; ++p) {
      tsp.item.push_back(i);
      tsp.mate.push_back(port + (two_ends ? 1 - p : p));
      ends.push_back({coordinate(), coordinate()});
    }
  }
  tsp.ports = static_cast<int>(ends.size());
  const bool has_finish = rng.Below(2) == 0;
  for (const Point& p : ends) {
    for (const Point& q : ends) tsp.cost.push_back(Distance(p, q));
    tsp.finish.push_back(has_finish ? Distance(p, {50, 0}) : 0);
    instance.start.push_back(rng.Below(5) == 0 ? kUnreached : Distance(p, {0, 0}));
  }
  instance.start[0] = 10;
  return instance;
}

double CostOf(const Instance& instance, const std::vector<int>& path) {
  double cost = instance.start[static_cast<size_t>(path.front())];
  const auto exit = [&](int port) { return instance.tsp.mate[static_cast<size_t>(port)]; };
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    cost += instance.tsp.Cost(exit(path[i]), path[i + 1]);
  }
  return cost + instance.tsp.finish[static_cast<size_t>(exit(path.back()))];
}

// The first port of each item, in the order given.
std::vector<int> FirstPorts(const PathTsp& tsp) {
  std::vector<int> firsts;
  for (int p = 0; p < tsp.ports; ++p) {
    if (p == 0 || tsp.item[static_cast<size_t>(p)] != tsp.item[static_cast<size_t>(p) - 1]) {
      firsts.push_back(p);
    }
  }
  return firsts;
}

// The least cost with items from `i` on entered at any of their ports.
double BestEntries(const Instance& instance, std::vector<int>& path, size_t i) {
  if (i == path.size()) return CostOf(instance, path);
  double best = kUnreached;
  const int first = path[i];
  const int item = instance.tsp.item[static_cast<size_t>(first)];
  for (int p = first; p < instance.tsp.ports && instance.tsp.item[static_cast<size_t>(p)] == item;
       ++p) {
    path[i] = p;
    best = std::min(best, BestEntries(instance, path, i + 1));
  }
  path[i] = first;
  return best;
}

// Tries all orders, directions and ports.
double BestCost(const Instance& instance) {
  std::vector<int> firsts = FirstPorts(instance.tsp);
  double best = kUnreached;
  do {
    best = std::min(best, BestEntries(instance, firsts, 0));
  } while (std::next_permutation(firsts.begin(), firsts.end()));
  return best;
}

TEST(PathTspSolver, FindsTheBestPath) {
  for (uint64_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Instance instance = RandomInstance(seed, static_cast<int>(2 + seed % 5));
    const double best = BestCost(instance);
    PathTspSolver solver(instance.tsp);
    Budget budget;

    EXPECT_LE(solver.RootBound(instance.start, 2 * best + 1, budget), best + 1e-7);
    const PathTspSolver::Result result = solver.Solve(instance.start, 2 * best + 1, {}, budget);

    EXPECT_TRUE(result.complete);
    ASSERT_FALSE(result.path.empty());
    EXPECT_NEAR(result.cost, best, 1e-9 * (1 + best));
    EXPECT_NEAR(CostOf(instance, result.path), result.cost, 1e-9 * (1 + best));
    EXPECT_NEAR(result.lower_bound, best, 1e-6 * (1 + best));
  }
}

TEST(PathTspSolver, FindsNothingBelowTheBestPath) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Instance instance = RandomInstance(seed, 5);
    const double best = BestCost(instance);
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
  Instance instance = RandomInstance(7, 6);
  PathTspSolver solver(instance.tsp);
  Budget budget;
  Rng rng(1);
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(absl::StrCat("round ", round));
    for (double& start : instance.start) start = rng.Below(3) == 0 ? kUnreached : 200 * rng.Unit();
    instance.start[0] = 100;
    const double best = BestCost(instance);

    const PathTspSolver::Result result =
        solver.Solve(instance.start, best + 20 * rng.Unit() + 1e-3, {}, budget);

    EXPECT_TRUE(result.complete);
    EXPECT_NEAR(result.cost, best, 1e-9 * (1 + best));
  }
}

// Clusters of five points in the plane, as GTSPLIB has them, are within reach at once; walks of
// half as much at each of two points of a cluster are what generalised subtours forbid.
TEST(PathTspSolver, ProvesClustersOfPoints) {
  Rng rng(5);
  Instance instance;
  PathTsp& tsp = instance.tsp;
  std::vector<Point> points;
  for (int item = 0; item < 30; ++item) {
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
  const double given = CostOf(instance, FirstPorts(tsp));
  PathTspSolver solver(tsp);
  Budget budget;

  const PathTspSolver::Result result = solver.Solve(instance.start, given, {}, budget);
  const double root = PathTspSolver(tsp).RootBound(instance.start, given, budget);

  EXPECT_TRUE(result.complete);
  EXPECT_NEAR(result.lower_bound, result.cost, 1e-6 * result.cost);
  EXPECT_NEAR(CostOf(instance, result.path), result.cost, 1e-9 * result.cost);
  EXPECT_GT(root, 0.97 * result.cost);
}

TEST(PathTspSolver, BoundsWhatItCannotSolveInTime) {
  const Instance instance = RandomInstance(3, 120);
  const std::vector<int> known = FirstPorts(instance.tsp);
  const double given = CostOf(instance, known);
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
