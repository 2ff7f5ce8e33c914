#include "engine/cost/wall_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/walled_problem.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// 100 mm/s at once; a retraction takes 0.5 s, beyond 20 mm or, across walls, beyond 1 mm.
CostSpec PrinterCost() {
  CostSpec spec;
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = 100;
  spec.retraction_seconds = 0.5;
  spec.retraction_threshold_mm = 20;
  spec.wall_retraction_threshold_mm = 1;
  spec.exposed_retraction_threshold_mm = 1;
  spec.lift_seconds = 0.25;
  spec.crossing_seconds = 2;
  return spec;
}

LayerWalls OneWall() { return {{{{{5, -50}, {5, 50}}, false, -1}}, {}}; }

TEST(WallCost, IsThatOfTheLengthWhereNoWallIsCrossed) {
  const WallCost cost(OneWall(), FlatPlan(1), PrinterCost());

  EXPECT_DOUBLE_EQ(cost({10, 0}, {20, 0}), 0.1);
  EXPECT_DOUBLE_EQ(cost({10, 0}, {40, 0}), 0.3 + 0.5);
  EXPECT_EQ(cost({10, 0}, {10, 0}), 0);
}

TEST(WallCost, HasRetractionLiftAndPriceAcrossAWall) {
  const WallCost cost(OneWall(), FlatPlan(1), PrinterCost());

  EXPECT_DOUBLE_EQ(cost({0, 0}, {10, 0}), 0.1 + 0.5 + 0.25 + 2);
  EXPECT_DOUBLE_EQ(cost({4.6, 0}, {5.4, 0}), 0.008 + 2);  // too short to be retracted
  EXPECT_DOUBLE_EQ(cost({0, 0}, {30, 0}), 0.3 + 0.5 + 0.25 + 2);
}

TEST(WallCost, LetsMovesBeginAndEndOnAWall) {
  const WallCost cost(OneWall(), FlatPlan(1), PrinterCost());

  EXPECT_DOUBLE_EQ(cost({4.9, 0}, {15, 0}), 0.101);
  EXPECT_DOUBLE_EQ(cost({-5, 0}, {5.1, 0}), 0.101);
  EXPECT_GT(cost({4.6, 0}, {15, 0}), 2);
}

TEST(WallCost, CountsWhatItIsAsked) {
  CostSpec spec = PrinterCost();
  spec.wall_clearance_mm = 0.4;
  LayerWalls square;
  square.walls.push_back({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, true, -1});
  const WallCost cost(square, FlatPlan(1), spec);
  EXPECT_EQ(cost.work(), 0);

  cost({20, 0}, {30, 0});
  const int64_t straight = cost.work();
  EXPECT_GT(straight, 1);
  cost({30, 0}, {20, 0});
  EXPECT_EQ(cost.work(), straight + 1);  // it is known
  cost({-5, 5}, {15, 5});
  EXPECT_GT(cost.work(), 3 * straight);  // there is a way around
}

TEST(WallCost, CountsWithTwoLayersWhatEitherIsAsked) {
  const WallCost first(OneWall(), FlatPlan(1), PrinterCost());
  const WallCost second(OneWall(), FlatPlan(1), PrinterCost());
  const std::vector<std::pair<Point, Point>> points = {{{7, 7}, {8, 8}}};
  const WallCost both(&first, &second, points, PrinterCost());

  both({0, 0}, {1, 1});
  both({0, 0}, {7, 7});

  EXPECT_GT(first.work(), 0);
  EXPECT_GT(second.work(), 0);
  EXPECT_EQ(both.work(), first.work() + second.work());
}

TEST(WallCost, RetractsToAndFromExposedPaths) {
  LayerWalls walls = OneWall();
  walls.exposed = {1};
  const Plan plan = AnyOrderPlan({MakeOpenPath({10, 0}, {11, 0}), MakeOpenPath({13, 0}, {14, 0})});
  const WallCost cost(walls, plan, PrinterCost());

  EXPECT_DOUBLE_EQ(cost({11, 0}, {13, 0}), 0.02 + 0.5);
  EXPECT_DOUBLE_EQ(cost({14, 0}, {10, 0}), 0.04 + 0.5);
  EXPECT_DOUBLE_EQ(cost({14, 0}, {14, 0.5}), 0.005);  // shorter than the threshold
}

// Filament is pulled back behind the second path in any case, and before it as often as behind.
TEST(WallCost, RetractionsThatAreMadeInAnyCaseAreNothingToSave) {
  LayerWalls walls = OneWall();
  walls.retracted = {1, 2};
  const Plan plan = AnyOrderPlan({MakeOpenPath({0, 0}, {0, 5}), MakeOpenPath({10, 0}, {10, 5}),
                                  MakeOpenPath({-10, 0}, {-10, 5})});
  const WallCost cost(walls, plan, PrinterCost());

  EXPECT_DOUBLE_EQ(cost({0, 5}, {10, 5}), 0.1 + 0.25 + 0.25 + 2);
  EXPECT_DOUBLE_EQ(cost({-10, 5}, {10, 5}), 0.2 + 0.25 + 2);
  EXPECT_DOUBLE_EQ(cost({-10, 5}, {10, 0}), cost({10, 0}, {-10, 5}));
  // Beyond the threshold of all moves it counts, so that a length bounds the cost.
  EXPECT_DOUBLE_EQ(cost({-10, 0}, {10, 5}), std::hypot(20, 5) / 100 + 0.5 + 0.25 + 2);
  EXPECT_TRUE(cost.MoveOf({-10, 5}, {10, 5}).retracts);
}

TEST(WallCost, MovesThatAreKnownCostWhatIsKnownInEitherDirection) {
  LayerWalls walls = OneWall();
  const Plan plan =
      AnyOrderPlan({MakeOpenPath({0, 0}, {0, 5}), MakeOpenPath({10, 0}, {10, 5}),
                    MakeContour({{-10, 0}, {-10, 5}, {-5, 5}}), MakeOpenPath({50, 50}, {50, 55})});
  walls.known = {{0, 1, 0.75}, {2, 0, 0.3, true, true}, {1, 2, 0.01}, {0, 1, 9}};
  const WallCost cost(walls, plan, PrinterCost());

  EXPECT_EQ(cost({0, 5}, {10, 0}), 0.75);  // the first one counts
  EXPECT_EQ(cost({10, 0}, {0, 5}), 0.75);
  EXPECT_FALSE(cost.MoveOf({0, 5}, {10, 0}).crosses);
  EXPECT_EQ(cost({-10, 0}, {0, 0}), 0.3 + 2);
  EXPECT_TRUE(cost.MoveOf({-10, 0}, {0, 0}).crosses);
  EXPECT_TRUE(cost.MoveOf({-10, 0}, {0, 0}).retracts);
  EXPECT_EQ(cost.PriceOf({-10, 0}, {0, 0}), 2);
  EXPECT_EQ(cost.PriceOf({0, 5}, {10, 0}), 0);
  // No less than the straight move without walls.
  EXPECT_DOUBLE_EQ(cost({10, 5}, {-10, 0}), std::hypot(20, 5) / 100 + 0.5);
  EXPECT_DOUBLE_EQ(cost({0, 0}, {10, 5}), std::hypot(10, 5) / 100 + 0.5 + 0.25 + 2);
}

TEST(WallCost, LeadsAWayAroundWhereThatCostsLess) {
  CostSpec spec = PrinterCost();
  spec.wall_clearance_mm = 0.4;
  spec.retraction_threshold_mm = 1000;
  // A slot from below into a plate, 2 mm wide and 20 mm deep.
  LayerWalls walls;
  walls.walls.push_back(
      {{{0, 0}, {19, 0}, {19, 20}, {21, 20}, {21, 0}, {40, 0}, {40, 40}, {0, 40}}, true, -1});
  const WallCost cost(walls, FlatPlan(1), spec);

  const WallMove move = cost.MoveOf({15, 10}, {25, 10});

  EXPECT_FALSE(move.crosses);
  EXPECT_FALSE(move.retracts);
  ASSERT_FALSE(move.via.empty());
  EXPECT_GT(move.length_mm, 24);
  EXPECT_LT(move.length_mm, 30);
  EXPECT_DOUBLE_EQ(move.cost, move.length_mm / 100);
  EXPECT_DOUBLE_EQ(cost({25, 10}, {15, 10}), move.cost);
  EXPECT_TRUE(cost.MoveOf({15, 10}, {60, 10}).crosses);  // outside
}

TEST(WallCost, OfAWayAroundHasAStopAtEachBend) {
  CostSpec spec = PrinterCost();
  spec.accel_mm_s2 = 1000;
  spec.retraction_threshold_mm = 22;
  spec.wall_clearance_mm = 0.4;
  LayerWalls walls;
  walls.walls.push_back(
      {{{0, 0}, {19, 0}, {19, 20}, {21, 20}, {21, 0}, {40, 0}, {40, 40}, {0, 40}}, true, -1});
  const WallCost cost(walls, FlatPlan(1), spec);

  const WallMove move = cost.MoveOf({15, 10}, {25, 10});

  ASSERT_GE(move.via.size(), 2u);
  const auto motion = [](double mm) { return mm < 10 ? 2 * std::sqrt(mm / 1000) : mm / 100 + 0.1; };
  double seconds = 0;
  Point at{15, 10};
  for (const Point& bend : move.via) {
    seconds += motion(Distance(at, bend));
    at = bend;
  }
  seconds += motion(Distance(at, {25, 10}));
  EXPECT_TRUE(move.retracts);
  EXPECT_NEAR(move.cost, seconds + 0.5, 1e-9);
  EXPECT_GT(seconds, 0.1 + move.length_mm / 100 + 0.05);
}

TEST(WallCost, EqualsABruteForceRecomputationAndIsNeverBelowItsBase) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled = RandomWalledProblem(seed, {.special = false});
    const TravelCost cost(walled.problem());
    Rng rng(StreamSeed(seed, 1));  // of its own: moves that are walls are another case
    for (int i = 0; i < 50; ++i) {
      const Point from{rng.Unit() * 100, rng.Unit() * 100};
      const Point to{rng.Unit() * 100, rng.Unit() * 100};

      EXPECT_NEAR(cost(from, to), WalledMoveCost(walled, from, to), 1e-9);
      EXPECT_EQ(cost(from, to), cost(to, from));
      EXPECT_GE(cost(from, to), cost.Base(from, to));
    }
    const std::vector<Path>& paths = walled.owned.plan().paths;
    for (int i = 0; i < 50 && !paths.empty(); ++i) {
      const auto any = [&rng, &paths] {
        const Path& path = paths[rng.Below(static_cast<uint32_t>(paths.size()))];
        return path.points[rng.Below(static_cast<uint32_t>(path.points.size()))];
      };
      const Point from = any();
      const Point to = any();
      EXPECT_EQ(cost(from, to), cost(to, from));
      EXPECT_GE(cost(from, to), cost.Base(from, to));
    }
    for (const KnownMove& move : walled.walls.known) {
      const Path& left = paths[static_cast<size_t>(move.from)];
      const Point from = left.points[left.kind == Path::Kind::kOpen ? 1 : 0];
      const Point to = paths[static_cast<size_t>(move.to)].points[0];
      EXPECT_NEAR(cost(from, to), WalledMoveCost(walled, from, to), 1e-9);
    }
  }
}

TEST(WallCost, OfWaysAroundIsBetweenItsBaseAndThatOfTheStraightMove) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled = RandomWalledProblem(seed, {.special = false}, true);
    const TravelCost cost(walled.problem());
    Rng rng(StreamSeed(seed, 1));  // of its own: moves that are walls are another case
    for (int i = 0; i < 50; ++i) {
      const Point from{rng.Unit() * 100, rng.Unit() * 100};
      const Point to{rng.Unit() * 100, rng.Unit() * 100};

      const WallMove move = walled.cost->MoveOf(from, to);

      EXPECT_DOUBLE_EQ(cost(from, to), move.cost);
      EXPECT_LE(move.cost, WalledMoveCost(walled, from, to) + 1e-9);
      EXPECT_GE(move.cost, cost.Base(from, to));
      Point at = from;
      for (const Point& bend : move.via) {
        EXPECT_FALSE(CrossesAny(walled.walls, walled.problem().cost.wall_slack_mm, at, bend));
        at = bend;
      }
    }
  }
}

TEST(WallCost, TakesNoNoticeOfTurningAndMoving) {
  for (const bool around : {false, true}) {
    for (uint64_t seed = 1; seed <= 100; ++seed) {
      SCOPED_TRACE(absl::StrCat("seed ", seed, around ? " around" : ""));
      const WalledProblem walled = RandomWalledProblem(seed, {.min_paths = 2}, around);
      const WalledProblem turned = Turned(walled, 0.3 + 0.01 * static_cast<double>(seed), {50, -9});
      const std::vector<Path>& paths = walled.owned.plan().paths;
      const std::vector<Path>& turned_paths = turned.owned.plan().paths;
      for (size_t p = 1; p < paths.size(); ++p) {
        EXPECT_NEAR((*walled.cost)(paths[p - 1].points.back(), paths[p].points[0]),
                    (*turned.cost)(turned_paths[p - 1].points.back(), turned_paths[p].points[0]),
                    1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace traverse
