#include "engine/strategy/greedy.h"

#include <gtest/gtest.h>

#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/instances.h"
#include "tests/support/random_plan.h"
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

}  // namespace
}  // namespace traverse
