#include "engine/exact/walk_bound.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/exact/stage_model.h"
#include "engine/exact/walk_conflicts.h"
#include "tests/support/brute_force.h"
#include "tests/support/random_plan.h"

namespace traverse {
namespace {

using testing::BruteForce;
using testing::OwnedProblem;
using testing::PlanShape;
using testing::RandomProblem;

TEST(BoundByWalks, ProvesWhatBruteForceFinds) {
  constexpr PlanShape kShapes[] = {PlanShape::kFlatContours, PlanShape::kSequential,
                                   PlanShape::kFlatBefore};
  for (uint64_t seed = 1; seed <= 240; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        RandomProblem(seed, {.shape = kShapes[seed % 3], .min_paths = 1, .max_paths = 7});
    const double best = BruteForce(owned.problem).cost;
    const std::optional<StageModel> model = StageModel::Build(owned.problem, 1 << 20);
    ASSERT_TRUE(model.has_value());
    Budget budget;

    // Little memory at first, so that all parts of the method have something to do.
    const WalkBoundResult result =
        BoundByWalks(*model, model->WalkOf(GivenRoute(owned.plan())),
                     {.first_memory = static_cast<int>(1 + seed % 3)}, budget);

    EXPECT_TRUE(result.proven);
    EXPECT_TRUE(ConflictsOf(*model, result.walk).empty());
    EXPECT_NEAR(result.cost, best, 1e-6 * (1 + best));
    EXPECT_NEAR(model->CostOf(result.walk), result.cost, 1e-9 * (1 + best));
    EXPECT_EQ(result.lower_bound, result.cost);
  }
}

TEST(BoundByWalks, BoundsWithoutAProofAreValid) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        RandomProblem(seed, {.shape = PlanShape::kSequential, .min_paths = 4, .max_paths = 7});
    const double best = BruteForce(owned.problem).cost;
    const std::optional<StageModel> model = StageModel::Build(owned.problem, 1 << 20);
    ASSERT_TRUE(model.has_value());
    Budget budget;

    const WalkBoundResult result =
        BoundByWalks(*model, model->WalkOf(GivenRoute(owned.plan())),
                     {.first_memory = 1, .most_passes = static_cast<int>(1 + seed % 5)}, budget);

    EXPECT_LE(result.lower_bound, best + 1e-9 * (1 + best));
    EXPECT_GE(result.cost, best - 1e-9 * (1 + best));
  }
}

}  // namespace
}  // namespace traverse
