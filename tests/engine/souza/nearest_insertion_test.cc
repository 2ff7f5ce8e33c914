#include "engine/souza/nearest_insertion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/wall_cost.h"
#include "engine/model/walls.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/problems/walled_problem.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

Route Inserted(const LayerProblem& problem) {
  Budget budget;
  return NearestInsertionRoute(LayerView(problem), budget).value();
}

// 0 is nearest to the start; then 1 is nearest to the route and costs least behind it; then 2,
// which costs less between the start and 0 than at the end.
TEST(NearestInsertion, InsertsWhereItCostsLeast) {
  const OwnedProblem owned(AnyOrderPlan(
      {MakeContour({{3, 0}}), MakeContour({{5, 0}}), MakeContour({{2, 2.5}, {9, 9}})}));

  EXPECT_EQ(Inserted(owned.problem), (Route{{2, 0}, {0, 0}, {1, 0}}));
}

// The first of those as near is inserted first, and what costs as much before it goes there.
TEST(NearestInsertion, OfTwoAsNearInsertsTheFirst) {
  const OwnedProblem owned(
      AnyOrderPlan({MakeContour({{3, 0}}), MakeContour({{0, 3}}), MakeContour({{-3, 0}})}));

  EXPECT_EQ(Inserted(owned.problem), (Route{{2, 0}, {1, 0}, {0, 0}}));
}

TEST(NearestInsertion, TakesTheEntryThatCostsLeastThere) {
  const OwnedProblem owned(
      AnyOrderPlan({MakeContour({{3, 0}}), MakeContour({{1, 3}, {1, 1}, {3, 4}}),
                    MakeOpenPath({9, 0}, {5, 0})}));

  EXPECT_EQ(Inserted(owned.problem), (Route{{1, 1}, {0, 0}, {2, 1}}));
}

// The last one also with regard to the finish.
TEST(NearestInsertion, PathsInOrderAreEnteredWhereItCostsLeast) {
  Plan plan = AnyOrderPlan({MakeContour({{9, 9}, {3, 0}, {8, 0}}),
                            MakeContour({{4, 5}, {5, 0}, {6, 0}}), MakeOpenPath({9, 0}, {7, 0})});
  plan.nodes[0].kind = PlanNode::Kind::kInOrder;
  OwnedProblem owned(std::move(plan));

  EXPECT_EQ(Inserted(owned.problem), (Route{{0, 1}, {1, 1}, {2, 1}}));
  owned.problem.finish = Point{0, 0};
  EXPECT_EQ(Inserted(owned.problem), (Route{{0, 1}, {1, 1}, {2, 0}}));
}

TEST(NearestInsertion, InsertsBehindWhatComesBefore) {
  Plan plan = FlatPlan(3);
  plan.nodes[0].before = {{2, 0}};
  const OwnedProblem owned(std::move(plan));

  EXPECT_EQ(Inserted(owned.problem), (Route{{1, 0}, {2, 0}, {0, 0}}));
}

TEST(NearestInsertion, LooksAheadToTheFinish) {
  OwnedProblem owned(FlatPlan(3), {5, 0});
  owned.problem.finish = Point{-5, 0};

  EXPECT_EQ(Inserted(owned.problem), (Route{{2, 0}, {1, 0}, {0, 0}}));
}

TEST(NearestInsertion, IsValidOnAnyPlan) {
  for (uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 40});

    EXPECT_OK(ValidateRoute(owned.plan(), Inserted(owned.problem)));
  }
}

TEST(NearestInsertion, BuildsNothingWithoutTime) {
  const OwnedProblem owned(InterleavedPlan(SquareGrid(5, 5)));
  CancelToken cancelled;
  cancelled.Cancel();
  Budget none(&cancelled);

  EXPECT_EQ(NearestInsertionRoute(LayerView(owned.problem), none), std::nullopt);
}

TEST(NearestInsertion, IsNoBetterThanTheOptimum) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 6});

    EXPECT_GE(RouteCost(owned.problem, Inserted(owned.problem)),
              BruteForce(owned.problem).cost - kCostTolerance);
  }
}

TEST(NearestInsertion, WallsThatNoMoveComesNearChangeNothing) {
  LayerWalls walls;
  walls.walls.emplace_back().points = {{1000, 1000}, {1001, 1000}};
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    OwnedProblem owned = RandomProblem(seed, {.max_paths = 20});
    owned.problem.cost.kind = CostSpec::Kind::kTime;
    const WallCost cost(walls, owned.plan(), owned.problem.cost);
    LayerProblem among = owned.problem;
    among.walls = &cost;

    EXPECT_EQ(Inserted(among), Inserted(owned.problem));
  }
}

// The paths of `problem`, all in any order, one after the other as the paper says: the nearest to
// the route next, where two of its moves cost least. Each place and each entry is looked at.
Route InsertedByBruteForce(const LayerProblem& problem) {
  const LayerView layer(problem);
  const EntryTable& table = layer.table;
  std::vector<int> entries;
  std::vector<Point> route_points = {problem.start};
  if (problem.finish) route_points.push_back(*problem.finish);
  std::vector<int> open(layer.plan().paths.size());
  std::iota(open.begin(), open.end(), 0);
  while (!open.empty()) {
    const auto distance = [&](int path) {
      double least = 1e18;
      for (int e = table.first(path); e < table.first(path + 1); ++e) {
        for (const Point p : route_points) {
          least = std::min({least, Distance(p, table.enter(e)), Distance(p, table.exit(e))});
        }
      }
      return least;
    };
    const auto next = std::min_element(open.begin(), open.end(), [&](int one, int other) {
      return distance(one) < distance(other);
    });
    const int path = *next;
    open.erase(next);
    double best = 1e18;
    std::pair<size_t, int> place;
    for (size_t at = 0; at <= entries.size(); ++at) {
      const Point from = at > 0 ? table.exit(entries[at - 1]) : problem.start;
      std::optional<Point> to = problem.finish;
      if (at < entries.size()) to = table.enter(entries[at]);
      const double present = to ? layer.cost(from, *to) : 0;
      for (int e = table.first(path); e < table.first(path + 1); ++e) {
        const double moves =
            layer.cost(from, table.enter(e)) + (to ? layer.cost(table.exit(e), *to) : 0);
        if (moves - present >= best) continue;
        best = moves - present;
        place = {at, e};
      }
    }
    entries.insert(entries.begin() + static_cast<std::ptrdiff_t>(place.first), place.second);
    route_points.push_back(table.enter(place.second));
    route_points.push_back(table.exit(place.second));
  }
  Route route;
  for (const int entry : entries) route.push_back(table.VisitOf(entry));
  return route;
}

TEST(NearestInsertion, AmongWallsInsertsWhereItCostsLeastToo) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled = RandomWalledProblem(seed, {.max_paths = 25}, seed % 2 == 0);
    OwnedProblem flat(AnyOrderPlan(walled.owned.plan().paths));
    const WallCost cost(walled.walls, flat.plan(), walled.problem().cost);
    flat.problem.cost = walled.problem().cost;
    flat.problem.walls = &cost;

    EXPECT_EQ(Inserted(flat.problem), InsertedByBruteForce(flat.problem));
  }
}

// A move as long as the threshold, within rounding, is no farther than what it costs allows.
TEST(NearestInsertion, AmongWallsFindsAPlaceAtTheThresholdOfRetraction) {
  LayerWalls walls;
  walls.walls.emplace_back().points = {{1000, 1000}, {1001, 1000}};
  for (int i = 1; i <= 100; ++i) {
    SCOPED_TRACE(absl::StrCat("threshold ", i));
    const Point there{0.01 * i, 0.003 * i * i};
    OwnedProblem owned(AnyOrderPlan({MakeContour({there}), MakeContour({{900, 900}})}));
    CostSpec& spec = owned.problem.cost;
    spec.kind = CostSpec::Kind::kTime;
    spec.retraction_seconds = 0.1;
    spec.retraction_threshold_mm = Distance({0, 0}, there);
    const WallCost cost(walls, owned.plan(), spec);
    owned.problem.walls = &cost;

    EXPECT_EQ(Inserted(owned.problem), (Route{{0, 0}, {1, 0}}));
  }
}

// A plate with holes: nearly all places are too far away to be worth the way around the walls.
TEST(NearestInsertion, AsksForFewWaysAmongWalls) {
  std::vector<Path> paths;
  LayerWalls walls;
  for (int row = 0; row < 12; ++row) {
    for (int column = 0; column < 12; ++column) {
      const double x = 5.0 * column;
      const double y = 5.0 * row;
      Wall& wall = walls.walls.emplace_back();
      wall.closed = true;
      wall.points = {{x, y}, {x + 3, y}, {x + 3, y + 3}, {x, y + 3}};
      paths.push_back(MakeContour({{x, y}, {x + 3, y}, {x + 3, y + 3}, {x, y + 3}}));
    }
  }
  const int64_t count = static_cast<int64_t>(paths.size());
  OwnedProblem owned(AnyOrderPlan(std::move(paths)));
  CostSpec& spec = owned.problem.cost;
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = 100;
  spec.retraction_seconds = 0.1;
  spec.retraction_threshold_mm = 1.5;
  spec.crossing_seconds = 0.1;
  spec.wall_clearance_mm = 0.4;
  const WallCost cost(walls, owned.plan(), spec);
  owned.problem.walls = &cost;

  const Route route = Inserted(owned.problem);

  EXPECT_OK(ValidateRoute(owned.plan(), route));
  EXPECT_LT(cost.work(), 3000 * count);
}

}  // namespace
}  // namespace traverse
