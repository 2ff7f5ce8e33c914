// Layers with walls on their way through a job.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/engine.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/walled_problem.h"
#include "tests/support/recording_sink.h"
#include "tests/support/status_matchers.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

JobLayer RandomLayer(uint64_t seed, bool around) {
  WalledProblem walled = RandomWalledProblem(seed, {.min_paths = 2, .max_paths = 25}, around);
  JobLayer layer;
  layer.plan = walled.owned.plan();
  layer.cost = walled.problem().cost;
  layer.more_follows = true;
  layer.walls = std::move(walled.walls);
  return layer;
}

std::map<uint64_t, LayerOutcome> RunJob(const std::vector<JobLayer>& layers, int threads,
                                        const char* strategy = "auto") {
  RecordingSink sink;
  TestExecutor executor(threads, TestExecutor::Order::kOldestFirst);
  JobSpec spec;
  spec.cleaning = CleaningSpec{{90, 90}, 5, 0};
  auto job = Job::Start(spec, *MakeStrategy(strategy, {}), executor, sink);
  for (const JobLayer& layer : layers) job->Add(layer);
  job->Close();
  sink.Wait();
  return sink.ByIndex();
}

TEST(LayersWithWalls, AreTheSameOnOneThreadAndOnEight) {
  std::vector<JobLayer> layers;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    for (const bool around : {false, true}) layers.push_back(RandomLayer(seed, around));
    layers.push_back(layers.back());  // an equal one
  }

  const auto one = RunJob(layers, 1);
  const auto eight = RunJob(layers, 8);

  ASSERT_EQ(one.size(), layers.size());
  for (const auto& [index, outcome] : one) {
    SCOPED_TRACE(absl::StrCat("layer ", index));
    EXPECT_EQ(outcome.route, eight.at(index).route);
    EXPECT_EQ(outcome.cost, eight.at(index).cost);
    EXPECT_EQ(outcome.moves, eight.at(index).moves);
    EXPECT_EQ(outcome.invalid_route, "");
  }
}

TEST(LayersWithWalls, SayWhatTheirMovesAre) {
  for (const char* strategy : {"none", "ni2opt", "auto"}) {
    std::vector<JobLayer> layers;
    for (uint64_t seed = 1; seed <= 20; ++seed) layers.push_back(RandomLayer(seed, seed % 2 == 0));
    for (const auto& [index, outcome] : RunJob(layers, 2, strategy)) {
      SCOPED_TRACE(absl::StrCat(strategy, " layer ", index));
      const JobLayer& layer = layers[index];

      EXPECT_OK(ValidateMoves(layer.plan, layer.walls, *layer.cost, outcome.start, outcome.route,
                              {outcome.cost, outcome.moves, outcome.detours}));
      EXPECT_TRUE(outcome.detours.empty() || layer.cost->wall_clearance_mm > 0);
    }
  }
}

// Two layers with the same points and different walls, done in view of each other.
TEST(Auto, EndsALayerInViewOfTheNextOneAmongItsOwnWalls) {
  const auto strategy = *MakeStrategy("auto", {});
  int gained = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem first = RandomWalledProblem(seed, {.min_paths = 3, .max_paths = 12});
    LayerProblem problem = first.problem();
    problem.finish.reset();
    LayerProblem next = problem;
    Rng rng(seed);
    const LayerWalls walls = RandomWalls(rng, *problem.plan);
    const WallCost cost(walls, *problem.plan, problem.cost);
    next.walls = &cost;
    Budget budget;
    const Route start = strategy->Solve(problem, budget).route;
    const Route known = strategy->Solve(next, budget).route;
    const auto both = [&](const Route& route, const Route& behind) {
      next.start = RouteEnd(*problem.plan, route, problem.start);
      return RouteCost(problem, route) + RouteCost(next, behind);
    };
    std::vector<NextLayer> seen = {{next, known}};

    const Solution solution = strategy->ResumeWithNext(problem, start, seen, budget);
    const Route& next_route = seen[0].route;

    ASSERT_OK(ValidateRoute(*problem.plan, solution.route));
    ASSERT_OK(ValidateRoute(*problem.plan, next_route));
    EXPECT_LE(both(solution.route, next_route), both(start, known) + 1e-6);
    gained += both(solution.route, next_route) < both(start, known) - 1e-6 ? 1 : 0;
  }
  EXPECT_GT(gained, 10);
}

// Two equal plans, one of them with a wall: what was found for the one is not taken over.
TEST(LayersWithWalls, AreNotTakenForLayersWithout) {
  std::vector<JobLayer> layers;
  for (int i = 0; i < 12; ++i) {
    layers.push_back(RandomLayer(5, false));
    layers.back().start = Point{0, 0};
    if (i % 2 == 0) layers.back().walls = {};
  }

  const auto outcomes = RunJob(layers, 2);

  for (const auto& [index, outcome] : outcomes) {
    EXPECT_EQ(outcome.moves.crossings > 0 || outcome.moves_given.crossings > 0, index % 2 == 1);
    EXPECT_EQ(outcome.invalid_route, "");
  }
}

}  // namespace
}  // namespace traverse
