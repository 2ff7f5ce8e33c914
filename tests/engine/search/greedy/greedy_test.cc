#include "engine/search/greedy/greedy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/wall_cost.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

Route Greedy(const LayerProblem& problem) {
  Budget budget;
  return GreedyRoute(LayerView(problem), budget);
}

TEST(Greedy, GoesToTheNearestVertexAndRasterEnd) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(2, 1)));

  EXPECT_EQ(Greedy(owned.problem), (Route{{0, 0}, {2, 0}, {3, 0}, {1, 1}}));
}

TEST(Greedy, BreaksTiesByTheLowestPathThenTheFirstEntry) {
  const OwnedProblem owned(AnyOrderPlan(
      {MakeContour({{5, 0}}), MakeContour({{9, 9}, {0, 1}, {1, 0}}), MakeContour({{-1, 0}})}));

  EXPECT_EQ(Greedy(owned.problem), (Route{{1, 1}, {2, 0}, {0, 0}}));
}

TEST(Greedy, CompletesANodeBeforeItLeavesIt) {
  // Two islands; the first has a far raster, and the second one a contour between it and the first.
  const OwnedProblem owned(
      InterleavedPlan({{{MakeContour({{0, 0}})}, {MakeOpenPath({9, 0}, {10, 0})}},
                       {{MakeContour({{2, 0}})}, {MakeOpenPath({3, 0}, {4, 0})}}}));

  EXPECT_EQ(Greedy(owned.problem), (Route{{0, 0}, {1, 0}, {2, 0}, {3, 0}}));
}

// What is as near within a nested node counts as if it were not nested.
TEST(Greedy, BreaksTiesByTheLowestPathAcrossNodesToo) {
  for (const int nested : {0, 1}) {
    Plan plan;
    plan.paths = {MakeContour({{1, 0}}), MakeContour({{-1, 0}}), MakeContour({{5, 0}})};
    plan.nodes = {PlanNode{PlanNode::Kind::kAnyOrder, 0, {1, 2}, {}},
                  PlanNode{PlanNode::Kind::kPath, 1 - nested, {}, {}},
                  PlanNode{PlanNode::Kind::kAnyOrder, 0, {3, 4}, {}},
                  PlanNode{PlanNode::Kind::kPath, nested, {}, {}},
                  PlanNode{PlanNode::Kind::kPath, 2, {}, {}}};
    const OwnedProblem owned(plan);

    EXPECT_EQ(Greedy(owned.problem).front(), (Visit{0, 0})) << "nested: path " << nested;
  }
}

// any_order nodes in each other, a contour beside each: the outermost ones offer what is innermost.
TEST(Greedy, LooksIntoNestedNodes) {
  Plan plan;
  for (int depth = 0; depth < 50; ++depth) {
    const int node = 2 * depth;
    plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {node + 1, node + 2}, {}});
    plan.nodes.push_back(PlanNode{PlanNode::Kind::kPath, depth, {}, {}});
    plan.paths.push_back(MakeContour({{-1.0 - depth, 0}}));
  }
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kPath, 50, {}, {}});
  plan.paths.push_back(MakeContour({{0.5, 0}}));
  const OwnedProblem owned(std::move(plan));
  ASSERT_OK(CheckPlan(owned.plan()));

  const Route route = Greedy(owned.problem);

  // Once inside, the way out goes from the innermost contour to the outermost.
  for (int i = 0; i <= 50; ++i) EXPECT_EQ(route[static_cast<size_t>(i)].path, 50 - i);
}

TEST(Greedy, WaitsForWhatComesBefore) {
  OwnedProblem owned([] {
    Plan plan = FlatPlan(4);
    plan.nodes[0].before = {{3, 0}, {2, 1}};
    return plan;
  }());

  EXPECT_EQ(Greedy(owned.problem), (Route{{2, 0}, {1, 0}, {3, 0}, {0, 0}}));
}

// The rule itself, by enumeration: the next visit has the nearest entry of all paths that a legal
// order may continue with, the lowest path and the first entry in case of ties.
Visit NearestLegal(const OwnedProblem& owned, const std::vector<std::vector<int>>& orders,
                   const Route& prefix, Point at) {
  std::vector<int> done;
  for (const Visit& visit : prefix) done.push_back(visit.path);
  const EntryTable table(owned.plan());
  double least = std::numeric_limits<double>::infinity();
  int nearest = 0;
  for (const std::vector<int>& order : orders) {
    if (!std::equal(done.begin(), done.end(), order.begin())) continue;
    const int path = order[done.size()];
    for (int e = table.first(path); e < table.first(path + 1); ++e) {
      const double dx = table.enter(e).x - at.x;
      const double dy = table.enter(e).y - at.y;
      const double squared = dx * dx + dy * dy;
      if (squared > least || (squared == least && e > nearest)) continue;
      least = squared;
      nearest = e;
    }
  }
  return table.VisitOf(nearest);
}

TEST(Greedy, AlwaysTakesTheNearestPointThatALegalOrderMayTakeNext) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 6});
    const std::vector<std::vector<int>> orders = LegalOrders(owned.plan());

    const Route route = Greedy(owned.problem);

    ASSERT_OK(ValidateRoute(owned.plan(), route));
    Point at = owned.problem.start;
    for (size_t i = 0; i < route.size(); ++i) {
      const Route prefix(route.begin(), route.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_EQ(route[i], NearestLegal(owned, orders, prefix, at)) << i;
      at = RouteEnd(owned.plan(), {route[i]}, at);
    }
  }
}

TEST(Greedy, IsValidOnLargerPlansAlsoWithoutTime) {
  CancelToken cancelled;
  cancelled.Cancel();
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 80});
    Budget none(&cancelled);

    EXPECT_OK(ValidateRoute(owned.plan(), Greedy(owned.problem)));
    EXPECT_OK(ValidateRoute(owned.plan(), GreedyRoute(LayerView(owned.problem), none)));
  }
}

TEST(BaselineRoute, IsTheCheaperOfGivenAndGreedy) {
  int given_is_better = 0;
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 6});
    Budget budget;
    const double given = RouteCost(owned.problem, GivenRoute(owned.plan()));
    const double greedy = RouteCost(owned.problem, Greedy(owned.problem));

    const Route route = BaselineRoute(LayerView(owned.problem), budget);

    EXPECT_EQ(RouteCost(owned.problem, route), std::min(given, greedy));
    given_is_better += given < greedy;
  }
  EXPECT_GT(given_is_better, 0);
}

// Where every move crosses a wall hundreds of times, the search for a detour takes so long that a
// job would end long after its deadline.
TEST(BaselineRoute, CostsLittleAmongManyWallsOnceTheBudgetIsExhausted) {
  Rng rng(1);
  const auto some_point = [&rng] { return Point{100 * rng.Unit(), 100 * rng.Unit()}; };
  std::vector<Path> paths;
  for (int i = 0; i < 3000; ++i) paths.push_back(MakeOpenPath(some_point(), some_point()));
  LayerWalls walls;
  walls.walls.push_back({{}, true, -1});
  for (int i = 0; i < 5000; ++i) walls.walls[0].points.push_back(some_point());
  OwnedProblem owned(AnyOrderPlan(std::move(paths)));
  CostSpec& spec = owned.problem.cost;
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = 100;
  spec.crossing_seconds = 10;
  spec.wall_clearance_mm = 0.3;
  const WallCost cost(walls, owned.plan(), spec);
  owned.problem.walls = &cost;
  const LayerView view(owned.problem);
  Budget budget = Budget().Within(std::chrono::milliseconds(20));

  EXPECT_OK(ValidateRoute(owned.plan(), BaselineRoute(view, budget)));

  EXPECT_TRUE(budget.was_exhausted());
  EXPECT_LT(cost.work(), 4'000'000);
}

}  // namespace
}  // namespace traverse
