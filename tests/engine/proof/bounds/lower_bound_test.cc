#include "engine/proof/bounds/lower_bound.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "tests/support/counting_turn.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

TEST(LowerBound, IsNeverAboveTheOptimum) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 7});
    const double best = testing::BruteForce(owned.problem).cost;
    Budget budget;

    const std::optional<double> bound = LowerBound(owned.problem, 2 * best + 1, nullptr, 1, budget);

    ASSERT_TRUE(bound.has_value());
    EXPECT_LE(*bound, best + 1e-9 * (1 + best));
  }
}

TEST(LowerBound, IsNeverAboveTheOptimumOfDegenerateGeometry) {
  for (const testing::Degeneracy degeneracy : testing::kDegeneracies) {
    for (uint64_t seed = 1; seed <= 100; ++seed) {
      SCOPED_TRACE(absl::StrCat("degeneracy ", static_cast<int>(degeneracy), ", seed ", seed));
      const OwnedProblem owned =
          testing::Degenerate(testing::RandomProblem(seed, {.max_paths = 6}), degeneracy);
      const double best = testing::BruteForce(owned.problem).cost;
      Budget budget;

      const std::optional<double> bound =
          LowerBound(owned.problem, 2 * best + 1, nullptr, 1, budget);

      ASSERT_TRUE(bound.has_value());
      EXPECT_LE(*bound, best + 1e-9 * (1 + best));
    }
  }
}

// Layers too large for brute force: what is proven by other means.
TEST(LowerBound, IsNeverAboveAProvenOptimum) {
  const std::unique_ptr<Strategy> exact = *MakeStrategy("exact", {});
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        testing::RandomProblem(seed, {.shape = testing::PlanShape::kSequential,
                                      .min_paths = 16,
                                      .max_paths = 30,
                                      .max_vertices = 8});
    Budget budget;
    const Solution proven = exact->Solve(owned.problem, budget);
    ASSERT_EQ(proven.stop, StopReason::kOptimal);
    const double best = RouteCost(owned.problem, proven.route);

    const double bound = *LowerBound(owned.problem, 2 * best, nullptr, 1, budget);

    EXPECT_LE(bound, best * (1 + 1e-9));
    EXPECT_GT(bound, 0.3 * best);
  }
}

// A route's cost is not known to be the least, and what a bound is at most must not make it so.
TEST(LowerBound, IsNeverAboveTheTarget) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 6});
    const double best = testing::BruteForce(owned.problem).cost;
    Budget budget;

    EXPECT_LE(LowerBound(owned.problem, best, nullptr, 1, budget), best);
  }
}

TEST(LowerBound, IsTightOnALine) {
  const OwnedProblem owned(testing::FlatPlan(30));
  Budget budget;

  EXPECT_NEAR(*LowerBound(owned.problem, 40, nullptr, 1, budget), 29, 1e-6);
}

// Points in the plane: the bound of Held and Karp is within a few percent of the optimum.
TEST(LowerBound, IsNearTheOptimumOfPoints) {
  Rng rng(5);
  std::vector<Path> paths;
  for (int i = 0; i < 60; ++i) paths.push_back(MakeContour({{100 * rng.Unit(), 100 * rng.Unit()}}));
  const OwnedProblem owned(testing::AnyOrderPlan(std::move(paths)));
  Budget budget;
  const double cost = RouteCost(owned.problem, GivenRoute(owned.plan()));

  const double rough = *LowerBound(owned.problem, cost, nullptr, 1, budget);

  EXPECT_GT(rough, 480);  // the best route known: 574
}

// A bound comes nearer with more effort, and never goes down.
TEST(LowerBound, IsMonotoneInTheEffort) {
  for (const int contours : {12, 40, 70}) {
    SCOPED_TRACE(contours);
    const OwnedProblem owned(testing::ClusterPlan(contours));
    Budget budget;
    const double cost =
        RouteCost(owned.problem, (*MakeStrategy("auto", {}))->Solve(owned.problem, budget).route);
    double last = 0;
    for (const double effort : {0.0, 0.25, 1.0, 2.0, 4.0}) {
      const double bound = *LowerBound(owned.problem, cost, nullptr, effort, budget);
      EXPECT_GE(bound, last) << "effort " << effort;
      last = bound;
    }
    EXPECT_GT(last, 0.93 * cost);
  }
}

// Of the route of `auto`.
double CostFound(const LayerProblem& problem) {
  Budget budget;
  return RouteCost(problem, (*MakeStrategy("auto", {}))->Solve(problem, budget).route);
}

// That the bound is below the route of `auto`, and above `share` of it.
void ExpectBoundNear(const OwnedProblem& owned, double share) {
  const double cost = CostFound(owned.problem);
  Budget budget;

  const double bound = *LowerBound(owned.problem, cost, nullptr, 1, budget);

  EXPECT_LE(bound, cost);
  EXPECT_GT(bound, share * cost) << bound / cost;
}

// Contours far wider than the ways between them: trees that join the nearest points of each two
// are at 0.52 of the shortest route here.
TEST(LowerBound, KnowsThatAContourIsLeftWhereItIsEntered) {
  Rng rng(7);
  std::vector<Path> paths;
  for (int i = 0; i < 40; ++i) {
    const Point middle{100 * rng.Unit(), 100 * rng.Unit()};
    std::vector<Point> vertices;
    for (int k = 0; k < 5; ++k) {
      vertices.push_back({middle.x + 20 * rng.Unit(), middle.y + 20 * rng.Unit()});
    }
    paths.push_back(MakeContour(std::move(vertices)));
  }

  ExpectBoundNear(OwnedProblem(testing::AnyOrderPlan(std::move(paths))), 0.9);
}

Plan CirclesPlan() {
  Rng rng(11);
  std::vector<Path> paths;
  for (int i = 0; i < 40; ++i) {
    const Point middle{100 * rng.Unit(), 100 * rng.Unit()};
    std::vector<Point> circle;
    for (int k = 0; k < 200; ++k) {
      const double angle = k * std::numbers::pi / 100;
      circle.push_back({middle.x + 3 * std::cos(angle), middle.y + 3 * std::sin(angle)});
    }
    paths.push_back(MakeContour(std::move(circle)));
  }
  return testing::AnyOrderPlan(std::move(paths));
}

// Contours of many points: which of them count is found out.
TEST(LowerBound, IsNearTheRouteAroundContoursOfManyPoints) {
  ExpectBoundNear(OwnedProblem(CirclesPlan()), 0.85);
}

// What was found for one start is a good beginning for another one, and no less is done.
TEST(LowerBound, IsNearlyAsGoodFromAnotherStart) {
  for (Plan plan : {testing::ClusterPlan(40), CirclesPlan()}) {
    OwnedProblem owned(std::move(plan));
    Budget budget;
    BoundMultipliers multipliers;
    LowerBound(owned.problem, CostFound(owned.problem), &multipliers, 1, budget);
    owned.problem.start = Point{-20, 10};
    const double target = CostFound(owned.problem);
    double afresh = 0;
    double onward = 0;

    const int asks_afresh = testing::AsksOf(
        [&](Budget& asked) { afresh = *LowerBound(owned.problem, target, nullptr, 1, asked); });
    const int asks_onward = testing::AsksOf([&](Budget& asked) {
      onward = *LowerBound(owned.problem, target, &multipliers, 1, asked);
    });

    EXPECT_GT(onward, 0.98 * afresh);
    EXPECT_GT(asks_onward, 0.85 * asks_afresh);
  }
}

// A few points of each of many contours, all over each other: the first rounds gain nothing.
TEST(LowerBound, IsMoreThanHalfOfARouteAmongScatteredContours) {
  Rng rng(5);
  std::vector<Path> paths;
  for (int i = 0; i < 60; ++i) {
    std::vector<Point> points;
    for (int k = 0; k < 5; ++k) points.push_back({200 * rng.Unit(), 200 * rng.Unit()});
    paths.push_back(MakeContour(std::move(points)));
  }
  const OwnedProblem owned(testing::AnyOrderPlan(std::move(paths)));
  Budget budget;
  const Solution found =
      (*MakeStrategy("auto", {{"bound", "false"}}))->Solve(owned.problem, budget);
  const double cost = RouteCost(owned.problem, found.route);

  EXPECT_GT(*LowerBound(owned.problem, cost, nullptr, 1, budget), 0.5 * cost);
}

// What was found for one start bounds the routes from another one.
TEST(LowerBound, IsValidWithMultipliersOfAnotherStart) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 6});
    Budget budget;
    BoundMultipliers multipliers;
    LowerBound(owned.problem, 1e6, &multipliers, 1, budget);
    owned.problem.start = Point{-50, 20};
    const double best = testing::BruteForce(owned.problem).cost;

    const std::optional<double> bound = LowerBound(owned.problem, 1e6, &multipliers, 1, budget);

    ASSERT_TRUE(bound.has_value());
    EXPECT_LE(*bound, best + 1e-9 * (1 + best));
  }
}

TEST(LowerBound, OfAnEmptyPlanIsWhatTheRestCosts) {
  OwnedProblem owned{Plan()};
  owned.problem.finish = Point{3, 4};
  Budget budget;

  EXPECT_EQ(LowerBound(owned.problem, 7, nullptr, 1, budget), 5);
}

TEST(LowerBound, IsNotGivenWithoutTime) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(12, 12)));
  Budget budget(nullptr, Budget::Clock::now());

  EXPECT_FALSE(LowerBound(owned.problem, 1e6, nullptr, 1, budget).has_value());
}

}  // namespace
}  // namespace traverse
