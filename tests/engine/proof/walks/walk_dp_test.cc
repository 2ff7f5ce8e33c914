#include "engine/proof/walks/walk_dp.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/proof/walks/walk_conflicts.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::BruteForce;
using testing::OwnedProblem;
using testing::PlanShape;
using testing::RandomProblem;
using Dp = WalkDp<1>;

constexpr double kNoLimit = 1e18;

// Models of random problems of all shapes that have stages.
struct Case {
  explicit Case(uint64_t seed)
      : owned(RandomProblem(seed, {.shape = kShapes[seed % 3], .min_paths = 1, .max_paths = 6})),
        model(*StageModel::Build(owned.problem, 1 << 20)) {}

  static constexpr PlanShape kShapes[] = {PlanShape::kFlatContours, PlanShape::kSequential,
                                          PlanShape::kFlatBefore};
  OwnedProblem owned;
  StageModel model;
};

std::vector<double> RandomMultipliers(Rng& rng, const StageModel& model) {
  std::vector<double> multipliers;
  for (int c = 0; c < model.cluster_count(); ++c) multipliers.push_back(rng.Unit() * 40 - 20);
  return multipliers;
}

// Each pair of one stage with a probability of 1 / `one_in`.
void Remember(Rng& rng, uint32_t one_in, const StageModel& model, Dp& dp) {
  for (int s = 0; s < model.stage_count(); ++s) {
    for (int a = model.first(s); a < model.first(s + 1); ++a) {
      for (int b = model.first(s); b < model.first(s + 1); ++b) {
        if (rng.Below(one_in) == 0) dp.Remember(a, b);
      }
    }
  }
}

TEST(WalkDp, WithAllMemoryTheLowestWalkIsTheBestRoute) {
  for (uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Case random(seed);
    const double best = BruteForce(random.owned.problem).cost;
    Rng rng(seed);
    Dp dp(random.model, random.model.stage_count());
    Remember(rng, 1, random.model, dp);
    dp.SetMultipliers(RandomMultipliers(rng, random.model));
    Budget budget;

    ASSERT_EQ(dp.Run(Dp::Direction::kForward, false, 0, kNoLimit, budget), Dp::Outcome::kDone);

    EXPECT_NEAR(dp.LowestCost(), best, 1e-9 * (1 + best));
    const std::vector<ClusterState> walk = dp.LowestWalk();
    EXPECT_TRUE(ConflictsOf(random.model, walk).empty());
    EXPECT_NEAR(random.model.CostOf(walk), best, 1e-9 * (1 + best));
  }
}

TEST(WalkDp, LessMemoryIsALowerBoundWithAWalkOfThatCost) {
  for (uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Case random(seed);
    const double best = BruteForce(random.owned.problem).cost;
    Rng rng(seed);
    Dp dp(random.model, random.model.stage_count());
    Remember(rng, 2, random.model, dp);
    const std::vector<double> multipliers = RandomMultipliers(rng, random.model);
    dp.SetMultipliers(multipliers);
    Budget budget;

    ASSERT_EQ(dp.Run(Dp::Direction::kForward, false, 0, kNoLimit, budget), Dp::Outcome::kDone);

    EXPECT_LE(dp.LowestCost(), best + 1e-9 * (1 + best));
    double penalised = random.model.CostOf(dp.LowestWalk());
    for (const double multiplier : multipliers) penalised -= multiplier;
    for (const ClusterState& at : dp.LowestWalk()) {
      penalised += multipliers[static_cast<size_t>(at.cluster)];
    }
    EXPECT_NEAR(dp.LowestCost(), penalised, 1e-9 * (1 + best));
  }
}

TEST(WalkDp, EliminationKeepsTheBestRoute) {
  for (uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Case random(seed);
    const double best = BruteForce(random.owned.problem).cost;
    const double most = best * (1 + 1e-9) + 1e-9;
    Rng rng(seed);
    Dp dp(random.model, random.model.stage_count());
    Budget budget;

    for (int round = 0; round < 4; ++round) {
      Remember(rng, 2, random.model, dp);
      dp.SetMultipliers(RandomMultipliers(rng, random.model));
      ASSERT_EQ(dp.Run(Dp::Direction::kForward, false, 0, kNoLimit, budget), Dp::Outcome::kDone);
      ASSERT_EQ(dp.Run(Dp::Direction::kBackward, true, most, kNoLimit, budget), Dp::Outcome::kDone);
      dp.Eliminate(most, budget);
      ASSERT_EQ(dp.Run(Dp::Direction::kForward, true, most, kNoLimit, budget), Dp::Outcome::kDone);
      EXPECT_LE(dp.LowestCost(), best + 1e-9 * (1 + best));
    }
    Remember(rng, 1, random.model, dp);
    ASSERT_EQ(dp.Run(Dp::Direction::kForward, false, 0, kNoLimit, budget), Dp::Outcome::kDone);

    EXPECT_NEAR(dp.LowestCost(), best, 1e-9 * (1 + best));
  }
}

TEST(WalkDp, EliminationBelowTheBestRouteLeavesNothing) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Case random(seed);
    const double best = BruteForce(random.owned.problem).cost;
    const double less = best * (1 - 1e-9) - 1e-9;
    Rng rng(seed);
    Dp dp(random.model, random.model.stage_count());
    Remember(rng, 1, random.model, dp);
    Budget budget;

    ASSERT_EQ(dp.Run(Dp::Direction::kForward, false, 0, kNoLimit, budget), Dp::Outcome::kDone);
    ASSERT_EQ(dp.Run(Dp::Direction::kBackward, true, less, kNoLimit, budget), Dp::Outcome::kDone);
    dp.Eliminate(less, budget);

    EXPECT_EQ(dp.alive_states(), 0);
  }
}

TEST(WalkDp, StopsForTheBudgetAndForTheLimitOfOperations) {
  const OwnedProblem owned =
      RandomProblem(1, {.shape = PlanShape::kFlatContours, .min_paths = 4, .max_paths = 4});
  const StageModel model = *StageModel::Build(owned.problem, 1 << 20);
  Dp dp(model, model.stage_count());
  CancelToken cancel;
  cancel.Cancel();
  Budget cancelled(&cancel);
  Budget budget;

  EXPECT_EQ(dp.Run(Dp::Direction::kForward, false, 0, kNoLimit, cancelled), Dp::Outcome::kStopped);
  EXPECT_EQ(dp.Run(Dp::Direction::kForward, false, 0, 1, budget), Dp::Outcome::kTooBig);
}

}  // namespace
}  // namespace traverse
