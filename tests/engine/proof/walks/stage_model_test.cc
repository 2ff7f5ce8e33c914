#include "engine/proof/walks/stage_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::OwnedProblem;
using testing::RandomProblem;

constexpr size_t kNoLimit = 1 << 20;

TEST(StageModel, WalksCostWhatTheirRoutesCost) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.min_paths = 1, .max_paths = 6});
    const Route route = testing::BruteForce(owned.problem).route;

    const std::optional<StageModel> model = StageModel::Build(owned.problem, kNoLimit);

    ASSERT_TRUE(model.has_value());
    EXPECT_EQ(model->RouteOf(model->WalkOf(route)), route);
    const double cost = RouteCost(owned.problem, route);
    EXPECT_NEAR(model->CostOf(model->WalkOf(route)), cost, 1e-12 * (1 + cost));
  }
}

TEST(StageModel, HoldsPrecedencesBothWays) {
  Plan plan = testing::FlatPlan(3);
  plan.nodes[0].before = {{2, 0}, {0, 1}};
  const OwnedProblem owned(std::move(plan));

  const std::optional<StageModel> model = StageModel::Build(owned.problem, kNoLimit);

  ASSERT_TRUE(model.has_value());
  EXPECT_THAT(model->Before(1), ::testing::UnorderedElementsAre(0, 2));
  EXPECT_THAT(model->After(2), ::testing::UnorderedElementsAre(0, 1));
  EXPECT_THAT(model->Before(2), ::testing::IsEmpty());
}

TEST(StageModel, IsNotBuiltBeyondTheLimit) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(3, 3)));

  EXPECT_TRUE(StageModel::Build(owned.problem, kNoLimit).has_value());
  EXPECT_FALSE(StageModel::Build(owned.problem, 100).has_value());
  EXPECT_TRUE(StageModel::Fits(owned.plan(), kNoLimit));
  EXPECT_FALSE(StageModel::Fits(owned.plan(), 100));
}

}  // namespace
}  // namespace traverse
