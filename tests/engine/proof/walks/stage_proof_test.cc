#include "engine/proof/walks/stage_proof.h"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/proof/walks/last_stage.h"
#include "engine/proof/walks/stage_model.h"
#include "engine/proof/walks/walk_conflicts.h"
#include "engine/proof/walks/walk_prover.h"
#include "tests/support/counting_turn.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/processor_watch.h"

namespace traverse {
namespace {

using testing::BruteForce;
using testing::OwnedProblem;
using testing::PlanShape;
using testing::RandomProblem;

constexpr PlanShape kShapes[] = {PlanShape::kFlatContours, PlanShape::kSequential,
                                 PlanShape::kFlatBefore, PlanShape::kInterleaved, PlanShape::kTree};
constexpr int kNever = 1000;

StageModel ModelOf(const OwnedProblem& owned) { return *StageModel::Build(owned.problem, 1 << 20); }

void ExpectProves(const OwnedProblem& owned, const StageProofOptions& options) {
  const double best = BruteForce(owned.problem).cost;
  const StageModel model = ModelOf(owned);
  Budget budget;

  const StageProof proof =
      ProveByStages(model, model.WalkOf(GivenRoute(owned.plan())), options, budget);

  EXPECT_TRUE(proof.proven);
  EXPECT_TRUE(ConflictsOf(model, proof.walk).empty());
  EXPECT_NEAR(proof.cost, best, 1e-6 * (1 + best));
  EXPECT_NEAR(model.CostOf(proof.walk), proof.cost, 1e-9 * (1 + best));
  EXPECT_EQ(proof.lower_bound, proof.cost);
}

TEST(ProveByStages, WalksProveWhatBruteForceFinds) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    // Little memory at first, so that all parts of the method have something to do.
    ExpectProves(RandomProblem(seed, {.shape = kShapes[seed % 5], .min_paths = 1, .max_paths = 7}),
                 {.walks = {.first_memory = static_cast<int>(1 + seed % 3)},
                  .least_items_to_branch = kNever});
  }
}

TEST(ProveByStages, BranchAndCutProvesWhatBruteForceFinds) {
  for (uint64_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    // Plans that end with a stage of items: contours with one point, or open paths; or that are one
    // stage of contours with a choice.
    const bool one_stage = seed % 3 == 0;
    OwnedProblem owned =
        RandomProblem(seed, {.shape = one_stage ? PlanShape::kFlatContours : PlanShape::kSequential,
                             .min_paths = 3,
                             .max_paths = 7,
                             .max_vertices = one_stage && seed % 2 == 0 ? 1 : 5});
    Plan plan = owned.plan();
    for (Path& path : plan.paths) path.one_way = false;
    OwnedProblem reversible(std::move(plan), owned.problem.start);
    reversible.problem.finish = owned.problem.finish;
    reversible.problem.cost = owned.problem.cost;

    ExpectProves(reversible, {.walks = {.first_memory = 2}, .least_items_to_branch = 2});
  }
}

// As closed jobs have it: everything in any order, and then the point where it began.
TEST(ProveByStages, BranchAndCutKnowsWhatComesLast) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        RandomProblem(seed, {.shape = PlanShape::kFlatContours, .min_paths = 3, .max_paths = 6});
    Plan plan = owned.plan();
    const int last = static_cast<int>(plan.paths.size());
    Path end = plan.paths.back();
    if (seed % 2 == 0) end.points.resize(1);
    plan.paths.push_back(std::move(end));
    plan.nodes = {{PlanNode::Kind::kInOrder, 0, {1, last + 2}, {}},
                  {PlanNode::Kind::kAnyOrder, 0, {}, {}}};
    for (int path = 0; path <= last; ++path) {
      if (path < last) plan.nodes[1].children.push_back(path + 2);
      plan.nodes.push_back({PlanNode::Kind::kPath, path, {}, {}});
    }
    OwnedProblem closed(std::move(plan), owned.problem.start);
    closed.problem.finish = owned.problem.finish;
    closed.problem.cost = owned.problem.cost;

    ExpectProves(closed, {.walks = {.first_memory = 2}, .least_items_to_branch = 2});
  }
}

// Ties, moves of no length, paths on top of each other.
TEST(ProveByStages, DegenerateGeometryIsProvenToo) {
  for (const testing::Degeneracy degeneracy : testing::kDegeneracies) {
    for (uint64_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(absl::StrCat("degeneracy ", static_cast<int>(degeneracy), ", seed ", seed));
      const OwnedProblem owned =
          RandomProblem(seed, {.shape = kShapes[seed % 5], .min_paths = 3, .max_paths = 6});
      ExpectProves(testing::Degenerate(owned, degeneracy),
                   {.walks = {.first_memory = 2}, .least_items_to_branch = 2});
    }
  }
}

TEST(ProveByStages, BoundsWithoutAProofAreValid) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned =
        RandomProblem(seed, {.shape = kShapes[seed % 5], .min_paths = 4, .max_paths = 7});
    const double best = BruteForce(owned.problem).cost;
    const StageModel model = ModelOf(owned);
    Budget budget;
    const auto prover = WalkProver::Make(model, model.stage_count(), {.first_memory = 1}, budget);

    prover->Run(1.5 * best + 1, static_cast<int>(1 + seed % 5), budget);

    EXPECT_LE(prover->lower_bound(), best + 1e-9 * (1 + best));
  }
}

TEST(ProveByStages, EqualDistancesAreNoTrouble) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(4, 3)));
  const StageModel model = ModelOf(owned);
  Budget budget;

  const StageProof proof = ProveByStages(model, model.WalkOf(GivenRoute(owned.plan())), {}, budget);

  EXPECT_TRUE(proof.proven);
  // Eleven moves of 3 mm between squares of side 1, and eleven of 3.5 mm or 4 mm between rasters.
  EXPECT_GE(proof.cost, 11 * 3 + 11 * 3.5);
}

// Before the first sample, each end of the stage before takes a while.
TEST(LastStage, AsksForEachEndThatItMaySample) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(6, 6)));
  const StageModel model = ModelOf(owned);
  ASSERT_EQ(model.stage_count(), 2);
  LastStage last(model);

  EXPECT_GE(testing::AsksOf([&](Budget& budget) { last.Sample(0, 1000, budget); }), 36);
}

// What is near each cluster is looked for among all moves.
TEST(WalkProver, AsksForEachClusterBeforeTheFirstPass) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(6, 6)));
  const StageModel model = ModelOf(owned);

  EXPECT_GE(testing::AsksOf([&](Budget& budget) { WalkProver::Make(model, 2, {}, budget); }), 72);
}

TEST(ProveByStages, GivesABoundWithinTheDeadline) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(12, 12)));
  const StageModel model = ModelOf(owned);
  const std::vector<ClusterState> given = model.WalkOf(GivenRoute(owned.plan()));
  Budget budget(nullptr, Budget::Clock::now() + std::chrono::milliseconds(150));
  const testing::ProcessorWatch watch;

  const StageProof proof = ProveByStages(model, given, {}, budget);

  EXPECT_LT(watch.Seconds(), 1.5);
  EXPECT_GE(proof.lower_bound, 0);
  EXPECT_LE(proof.lower_bound, proof.cost);
  EXPECT_LE(proof.cost, model.CostOf(given));
}

}  // namespace
}  // namespace traverse
