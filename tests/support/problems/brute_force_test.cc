#include "tests/support/problems/brute_force.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/cost/route_cost.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

TEST(LegalOrders, AreThoseThatTheTreeAllows) {
  Plan plan = FlatPlan(3);
  EXPECT_THAT(LegalOrders(plan), SizeIs(6));

  plan.nodes[0].before = {{2, 0}};
  EXPECT_THAT(LegalOrders(plan), UnorderedElementsAre(ElementsAre(2, 0, 1), ElementsAre(2, 1, 0),
                                                      ElementsAre(1, 2, 0)));

  plan.nodes[0].before.clear();
  plan.nodes[0].kind = PlanNode::Kind::kInOrder;
  EXPECT_THAT(LegalOrders(plan), ElementsAre(ElementsAre(0, 1, 2)));
}

TEST(LegalOrders, OfAnEmptyPlanIsTheEmptyOrder) {
  EXPECT_THAT(LegalOrders(Plan{}), ElementsAre(ElementsAre()));
}

TEST(BruteForce, FindsTheStraightLine) {
  OwnedProblem owned(FlatPlan(4), {-1, 0});

  const BruteForceResult result = BruteForce(owned.problem);

  EXPECT_DOUBLE_EQ(result.cost, 4);
  EXPECT_EQ(result.route, (Route{{0, 0}, {1, 0}, {2, 0}, {3, 0}}));
}

TEST(BruteForce, CostIsTheCostOfItsRoute) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 5});

    const BruteForceResult result = BruteForce(owned.problem);

    EXPECT_NEAR(result.cost, RouteCost(owned.problem, result.route), 1e-9);
    EXPECT_LE(result.cost, RouteCost(owned.problem, GivenRoute(owned.plan())) + 1e-9);
  }
}

}  // namespace
}  // namespace traverse::testing
