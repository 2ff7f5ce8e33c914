#include "engine/souza/nearest_insertion.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/wall_cost.h"
#include "engine/model/walls.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
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
