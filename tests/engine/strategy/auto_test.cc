#include "engine/strategy/auto.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/model/layers_in_order.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/counting_turn.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

Solution Solve(const LayerProblem& problem) {
  Budget budget;
  return (*MakeStrategy("auto", {}))->Solve(problem, budget);
}

TEST(Auto, IsTheDefault) { EXPECT_EQ(DefaultStrategyName(), "auto"); }

TEST(Auto, FindsTheOptimumOfNearlyAllSmallPlans) {
  int optimal = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 7});

    const Solution solution = Solve(owned.problem);

    optimal +=
        RouteCost(owned.problem, solution.route) <= BruteForce(owned.problem).cost + kCostTolerance;
  }
  EXPECT_GE(optimal, 195);
}

TEST(Auto, ProvesTheOptimumWhereTheOrderIsFixed) {
  Plan plan = FlatPlan(5);
  plan.nodes[0].kind = PlanNode::Kind::kInOrder;
  const OwnedProblem owned(plan);

  const Solution solution = Solve(owned.problem);

  EXPECT_EQ(solution.stop, StopReason::kOptimal);
  EXPECT_EQ(solution.lower_bound, RouteCost(owned.problem, solution.route));
}

TEST(Auto, IsFarBetterThanGreedyOnAGrid) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(12, 12)));
  Budget budget;
  const Route greedy = (*MakeStrategy("greedy", {}))->Solve(owned.problem, budget).route;

  const Solution solution = Solve(owned.problem);

  EXPECT_LT(RouteCost(owned.problem, solution.route), 0.95 * RouteCost(owned.problem, greedy));
  EXPECT_GT(solution.statistics.at("iterations"), 0);
}

// Little more effort than a single walk has is worth more when it is spent on walks of their own.
TEST(Auto, SpendsMuchEffortOnManyWalks) {
  double by_one = 0;
  double by_many = 0;
  for (uint64_t seed = 1; seed <= 2; ++seed) {
    OwnedProblem owned =
        RandomProblem(seed, {.shape = PlanShape::kFlatBefore, .min_paths = 50, .max_paths = 50});
    const auto cost = [&owned](const char* effort) {
      Budget budget;
      const Solution solution =
          (*MakeStrategy("auto", {{"effort", effort}}))->Solve(owned.problem, budget);
      return RouteCost(owned.problem, solution.route);
    };
    by_one += cost("4");
    by_many += cost("4.1");
  }
  EXPECT_LT(by_many, 0.99 * by_one);
}

TEST(Auto, DoesMoreWithMoreEffort) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(6, 6)));
  Budget budget;
  const auto iterations = [&](const char* effort) {
    const auto strategy = *MakeStrategy("auto", {{"effort", effort}});
    return strategy->Solve(owned.problem, budget).statistics.at("iterations");
  };

  EXPECT_LT(iterations("0.5"), iterations("4"));
  EXPECT_EQ(iterations("0"), 0);
}

TEST(Auto, DerivesWhatItNeedsOfAPreparedPlanOnce) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(8, 8)));
  const auto strategy = *MakeStrategy("auto", {});
  const auto prepared = strategy->Prepare(owned.plan());
  Budget budget;
  const Route route = prepared->Solve(owned.problem, budget).route;
  LayerProblem elsewhere = owned.problem;
  elsewhere.start = {40, 70};

  const int first = AsksOf([&](Budget& b) { strategy->Resume(elsewhere, route, b); });
  const int again = AsksOf([&](Budget& b) { prepared->Resume(elsewhere, route, b); });

  // The neighbors of a path are looked for with one ask at least.
  EXPECT_LE(again, first - static_cast<int>(owned.plan().paths.size()));
}

TEST(Auto, StopsAtTheDeadline) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(30, 30)));
  Budget budget = Budget().Within(std::chrono::milliseconds(30));

  const Solution solution = (*MakeStrategy("auto", {}))->Solve(owned.problem, budget);

  EXPECT_EQ(solution.stop, StopReason::kTimeLimit);
  EXPECT_OK(ValidateRoute(owned.plan(), solution.route));
}

TEST(Auto, TwoLayersNeverGetWorseTogetherAndWhatIsProvenHoldsForTheFirst) {
  const auto strategy = *MakeStrategy("auto", {});
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    OwnedProblem first = RandomProblem(seed, {.max_paths = 6});
    OwnedProblem second = RandomProblem(seed + 1000, {.max_paths = 6});
    first.problem.finish.reset();
    second.problem.cost = first.problem.cost;
    const Route start = GivenRoute(*first.problem.plan);
    const auto total = [&](const Route& route, const Route& next) {
      LayerProblem after = second.problem;
      after.start = RouteEnd(*first.problem.plan, route, first.problem.start);
      return RouteCost(first.problem, route) + RouteCost(after, next);
    };
    std::vector<NextLayer> next = {{second.problem, GivenRoute(*second.problem.plan)}};
    const double before = total(start, next[0].route);
    Budget budget;

    const Solution solution = strategy->ResumeWithNext(first.problem, start, next, budget);

    ASSERT_TRUE(ValidateRoute(*first.problem.plan, solution.route).ok());
    ASSERT_TRUE(ValidateRoute(*second.problem.plan, next[0].route).ok());
    EXPECT_LE(total(solution.route, next[0].route), before + kCostTolerance);
    const double least = BruteForce(first.problem).cost;
    EXPECT_LE(solution.lower_bound.value_or(0), least + kCostTolerance);
    if (solution.stop == StopReason::kOptimal) {
      EXPECT_LE(RouteCost(first.problem, solution.route), least + kCostTolerance);
    }
  }
}

TEST(Auto, MoreLayersNeverGetWorseTogetherAndSmallOnesAreBestTogether) {
  const auto strategy = *MakeStrategy("auto", {});
  int best = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    OwnedProblem first = RandomProblem(seed, {.max_paths = 3});
    first.problem.finish.reset();
    std::vector<Plan> plans;
    for (uint64_t i = 1; i <= 2; ++i)
      plans.push_back(RandomPlan(seed + 1000 * i, {.max_paths = 3}));
    std::vector<NextLayer> next;
    std::vector<const Plan*> all = {first.problem.plan};
    for (const Plan& plan : plans) {
      LayerProblem problem = first.problem;
      problem.plan = &plan;
      next.push_back({problem, GivenRoute(plan)});
      all.push_back(&plan);
    }
    const Plan joined = PlanInOrder(all);
    LayerProblem together = first.problem;
    together.plan = &joined;
    const auto total = [&](const Route& route) {
      return RouteCost(together, RouteInOrder({&route, &next[0].route, &next[1].route}));
    };
    const Route start = GivenRoute(*first.problem.plan);
    const double before = total(start);
    Budget budget;

    const Solution solution = strategy->ResumeWithNext(first.problem, start, next, budget);

    ASSERT_TRUE(ValidateRoute(*first.problem.plan, solution.route).ok());
    for (size_t i = 0; i < 2; ++i) ASSERT_TRUE(ValidateRoute(plans[i], next[i].route).ok());
    const double after = total(solution.route);
    EXPECT_LE(after, before + kCostTolerance);
    best += after <= BruteForce(together).cost + kCostTolerance ? 1 : 0;
  }
  EXPECT_GE(best, 58);
}

TEST(Auto, LooksAheadFromLargerLayersWhereNoIterationHasToPay) {
  const auto patient = *MakeStrategy("auto", {});
  const auto hasty = *MakeStrategy("auto", {{"least_gain_each", "1e-4"}});

  EXPECT_EQ(patient->traits().look_ahead_paths, 20'000u);
  EXPECT_EQ(patient->traits().look_further_paths, 150u);
  EXPECT_EQ(hasty->traits().look_ahead_paths, 64u);
  EXPECT_EQ(hasty->traits().look_further_paths, 0u);
}

TEST(Auto, EndsWhenSearchingOnSavesLessTravelThanItTakes) {
  const Plan plan = FlatPlan(120);
  const LayerProblem problem{&plan, {0, 0}, std::nullopt, CostSpec(), 1};
  const auto iterations = [&](const std::string& speed) {
    Budget budget;
    const auto strategy = *MakeStrategy("auto", {{"idle_speed", speed}});
    return strategy->Solve(problem, budget).statistics.at("iterations");
  };

  EXPECT_LE(iterations("100000"), 1001);
  EXPECT_GE(iterations("0"), 1400);
}

// However little a second is worth.
TEST(Auto, SearchesTwoLayersNoHarderThanOneWhereTimeCounts) {
  const Plan plan = FlatPlan(6);
  const Route given = GivenRoute(plan);
  const LayerProblem problem{&plan, {0, 0}, std::nullopt, CostSpec(), 1};
  const auto iterations = [&](const std::string& speed) {
    Budget budget;
    std::vector<NextLayer> next = {{problem, given}};
    const auto strategy = *MakeStrategy("auto", {{"idle_speed", speed}});
    return strategy->ResumeWithNext(problem, given, next, budget).statistics.at("iterations");
  };

  EXPECT_LT(iterations("1e-9"), 600);
  EXPECT_GT(iterations("0"), 700);
}

}  // namespace
}  // namespace traverse
