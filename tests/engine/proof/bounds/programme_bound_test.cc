#include "engine/proof/bounds/programme_bound.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/proof/bounds/lower_bound.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(ProgrammeBound, IsNeverAboveTheBestRoute) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        RandomProblem(seed, {.shape = PlanShape::kFlatContours, .min_paths = 2, .max_paths = 6});
    const double best = BruteForce(owned.problem).cost;
    Budget budget;

    const std::optional<double> bound = ProgrammeBound(owned.problem, 2 * best + 1, 1, budget);

    ASSERT_TRUE(bound.has_value());
    EXPECT_LE(*bound, best + 1e-9 * (1 + best));
    EXPECT_GE(*bound, 0.8 * best);
  }
}

TEST(ProgrammeBound, ComesNearerWithMoreEffort) {
  const OwnedProblem owned(ClusterPlan(50));
  Budget budget;
  const double cost = RouteCost(owned.problem, GivenRoute(owned.plan()));

  const double quick = *ProgrammeBound(owned.problem, cost, 1, budget);
  const double slow = *ProgrammeBound(owned.problem, cost, 8, budget);

  EXPECT_GT(slow, 1.02 * quick);
  EXPECT_GE(*LowerBound(owned.problem, cost, nullptr, 8, budget), slow);
}

TEST(ProgrammeBound, IsForLayersThatAreOneStageOfSmallContours) {
  Budget budget;
  const OwnedProblem stages(SequentialPlan(SquareGrid(3, 3)));

  EXPECT_EQ(ProgrammeBound(stages.problem, 1e6, 1, budget), std::nullopt);
}

TEST(ProgrammeBound, IsForLayersOfFewPointsWithLittleEffort) {
  const OwnedProblem owned(ClusterPlan(60));
  Budget budget;

  EXPECT_EQ(ProgrammeBound(owned.problem, 1e6, 1, budget), std::nullopt);
  EXPECT_NE(ProgrammeBound(owned.problem, 1e6, 2, budget), std::nullopt);
}

TEST(ProgrammeBound, EndsWithItsBudget) {
  const OwnedProblem owned(ClusterPlan(50));
  CancelToken cancel;
  cancel.Cancel();
  Budget cancelled(&cancel);

  EXPECT_EQ(ProgrammeBound(owned.problem, 1e6, 1, cancelled), std::nullopt);
}

}  // namespace
}  // namespace traverse
