// What every strategy promises (engine/strategy/strategy.h), on every plan.

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/processor_watch.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

class EveryStrategy : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { ASSERT_OK_AND_ASSIGN(strategy_, MakeStrategy(GetParam(), {})); }

  double Cost(const LayerProblem& problem, const Route& route) { return RouteCost(problem, route); }

  // Of the first such strategy: what no other one may fall behind.
  double GreedyCost(const LayerProblem& problem) {
    Budget budget;
    return Cost(problem, (*MakeStrategy("greedy", {}))->Solve(problem, budget).route);
  }

  std::unique_ptr<Strategy> strategy_;
};

TEST_P(EveryStrategy, IsBetweenTheOptimumAndGreedyOnSmallPlans) {
  for (uint64_t seed = 1; seed <= 75; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 6});
    Budget budget;

    const Solution solution = strategy_->Solve(owned.problem, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
    const double cost = Cost(owned.problem, solution.route);
    const double optimum = BruteForce(owned.problem).cost;
    EXPECT_GE(cost, optimum - kCostTolerance);
    EXPECT_LE(cost, Cost(owned.problem, GivenRoute(owned.plan())) + kCostTolerance);
    if (GetParam() != "none") {
      EXPECT_LE(cost, GreedyCost(owned.problem) + kCostTolerance);
    }
    if (solution.lower_bound) {
      EXPECT_LE(*solution.lower_bound, optimum + kCostTolerance);
    }
    EXPECT_NE(solution.stop, StopReason::kTimeLimit);
    EXPECT_NE(solution.stop, StopReason::kCancelled);
  }
}

// How long the search for a larger plan may take here.
constexpr auto kShort = std::chrono::milliseconds(200);

TEST_P(EveryStrategy, IsValidAndNotBehindGreedyOnLargerPlans) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.min_paths = 10, .max_paths = 60});
    Budget budget = Budget().Within(kShort);

    const Solution solution = strategy_->Solve(owned.problem, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
    const double cost = Cost(owned.problem, solution.route);
    EXPECT_LE(cost, Cost(owned.problem, GivenRoute(owned.plan())) + kCostTolerance);
    if (GetParam() != "none") {
      EXPECT_LE(cost, GreedyCost(owned.problem) + kCostTolerance);
    }
  }
}

TEST_P(EveryStrategy, ReturnsTheSameRouteForTheSameProblem) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 9});
    Budget budget;

    const Solution first = strategy_->Solve(owned.problem, budget);
    const Solution second = strategy_->Solve(owned.problem, budget);

    EXPECT_EQ(first.route, second.route);
    EXPECT_EQ(first.stop, second.stop);
  }
}

TEST_P(EveryStrategy, ReturnsAValidRouteAfterTheDeadline) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 60});
    Budget late(nullptr, Budget::Clock::now() - std::chrono::seconds(1));

    const Solution solution = strategy_->Solve(owned.problem, late);

    ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
    EXPECT_LE(Cost(owned.problem, solution.route),
              Cost(owned.problem, GivenRoute(owned.plan())) + kCostTolerance);
  }
}

TEST_P(EveryStrategy, ResumeNeverReturnsAWorseRoute) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 8});
    const double optimum = BruteForce(owned.problem).cost;
    const Route given = GivenRoute(owned.plan());
    const Route best = BruteForce(owned.problem).route;
    Budget budget;

    const Solution from_given = strategy_->Resume(owned.problem, given, budget);
    const Solution from_best = strategy_->Resume(owned.problem, best, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), from_given.route));
    ASSERT_OK(ValidateRoute(owned.plan(), from_best.route));
    EXPECT_LE(Cost(owned.problem, from_given.route), Cost(owned.problem, given) + kCostTolerance);
    EXPECT_NEAR(Cost(owned.problem, from_best.route), optimum, kCostTolerance);
  }
}

TEST_P(EveryStrategy, AnswersTheSameWhereItPreparedThePlan) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    OwnedProblem owned = RandomProblem(seed, {.max_paths = 9});
    OwnedProblem next = RandomProblem(seed + 1000, {.max_paths = 9});
    owned.problem.finish.reset();
    next.problem.cost = owned.problem.cost;
    LayerProblem elsewhere = owned.problem;
    elsewhere.start = {40, 70};
    const auto prepared = strategy_->Prepare(owned.plan());
    Budget budget;

    const Solution solved = prepared->Solve(owned.problem, budget);
    const Solution resumed = prepared->Resume(elsewhere, solved.route, budget);
    std::vector<NextLayer> seen = {{next.problem, GivenRoute(next.plan())}};
    const Solution seeing = prepared->ResumeWithNext(elsewhere, resumed.route, seen, budget);

    EXPECT_EQ(solved.route, strategy_->Solve(owned.problem, budget).route);
    const Solution resumed_alone = strategy_->Resume(elsewhere, solved.route, budget);
    EXPECT_EQ(resumed.route, resumed_alone.route);
    EXPECT_EQ(resumed.lower_bound, resumed_alone.lower_bound);
    std::vector<NextLayer> seen_alone = {{next.problem, GivenRoute(next.plan())}};
    EXPECT_EQ(seeing.route,
              strategy_->ResumeWithNext(elsewhere, resumed.route, seen_alone, budget).route);
    EXPECT_EQ(seen[0].route, seen_alone[0].route);
  }
}

TEST_P(EveryStrategy, StopsSoonAfterItIsCancelled) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(50, 50)));
  CancelToken token;
  Budget budget(&token);
  std::optional<testing::ProcessorWatch> since_cancel;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    since_cancel.emplace();
    token.Cancel();
  });

  const Solution solution = strategy_->Solve(owned.problem, budget);

  canceller.join();
  EXPECT_OK(ValidateRoute(owned.plan(), solution.route));
  // The promise is 50 ms; sanitizers need more.
  EXPECT_LT(since_cancel->Seconds(), 1);
}

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const StrategyEntry& entry : Strategies()) names.push_back(entry.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, EveryStrategy, ::testing::ValuesIn(Names()),
                         [](const auto& info) { return info.param; });

// Whatever the search came to.
TEST(Strategies, SolveSmallPlansToOptimality) {
  for (const char* name : {"auto", "tabu", "exact"}) {
    const auto strategy = *MakeStrategy(name, {});
    for (uint64_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(absl::StrCat(name, ", seed ", seed));
      const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 7});
      Budget budget;

      const Solution solution = strategy->Solve(owned.problem, budget);

      const double best = testing::BruteForce(owned.problem).cost;
      EXPECT_EQ(solution.stop, StopReason::kOptimal);
      EXPECT_NEAR(RouteCost(owned.problem, solution.route), best, 1e-6 * (1 + best));
      EXPECT_EQ(solution.lower_bound, RouteCost(owned.problem, solution.route));
    }
  }
}

}  // namespace
}  // namespace traverse
