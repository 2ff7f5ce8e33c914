#include "engine/strategy/greedy.h"

#include <gtest/gtest.h>

#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(GreedyStrategy, KeepsTheOrderGivenWhereGreedyIsLonger) {
  // Greedy goes to 1, -2 and 8, in all 14 mm; the order given 2 + 10 = 12 mm.
  const OwnedProblem owned(
      AnyOrderPlan({MakeContour({{-2, 0}}), MakeContour({{1, 0}}), MakeContour({{8, 0}})}));
  ASSERT_OK_AND_ASSIGN(const auto strategy, MakeStrategy("greedy", {}));
  Budget budget;

  const Solution solution = strategy->Solve(owned.problem, budget);

  EXPECT_DOUBLE_EQ(RouteCost(owned.problem, solution.route), 12);
  EXPECT_EQ(solution.stop, StopReason::kLocalOptimum);
}

TEST(GreedyStrategy, SaysWhyItStopped) {
  const OwnedProblem owned(SequentialPlan(SquareGrid(20, 20)));
  ASSERT_OK_AND_ASSIGN(const auto strategy, MakeStrategy("greedy", {}));
  CancelToken cancelled;
  cancelled.Cancel();
  Budget cancelled_budget(&cancelled);
  Budget late(nullptr, Budget::Clock::now());

  const Solution first = strategy->Solve(owned.problem, cancelled_budget);
  const Solution second = strategy->Solve(owned.problem, late);

  EXPECT_EQ(first.stop, StopReason::kCancelled);
  EXPECT_OK(ValidateRoute(owned.plan(), first.route));
  EXPECT_EQ(second.stop, StopReason::kTimeLimit);
  EXPECT_OK(ValidateRoute(owned.plan(), second.route));
}

// The sources' method 1 has nothing behind it: on a zigzag given in its order it loses.
TEST(Greedy, PureMayBeLongerThanTheOrderGiven) {
  OwnedProblem owned(testing::AnyOrderPlan(
      {MakeContour({{-2, 0}}), MakeContour({{1, 0}}), MakeContour({{9, 0}})}));
  Budget budget;

  const Solution usual = (*MakeStrategy("greedy", {}))->Solve(owned.problem, budget);
  const Solution pure = (*MakeStrategy("greedy", {{"pure", "true"}}))->Solve(owned.problem, budget);

  // To 1, to -2 (3 away), to 9: 1 + 3 + 11. Given: 2 + 3 + 8.
  EXPECT_NEAR(RouteCost(owned.problem, pure.route), 15, 1e-9);
  EXPECT_NEAR(RouteCost(owned.problem, usual.route), 13, 1e-9);
  EXPECT_TRUE((*MakeStrategy("greedy", {{"pure", "true"}}))->traits().pure);
}

}  // namespace
}  // namespace traverse
