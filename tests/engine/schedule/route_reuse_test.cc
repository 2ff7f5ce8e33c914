// The chain where layers go on from the routes of equal ones.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/schedule/layer_chain.h"
#include "engine/strategy/registry.h"
#include "tests/engine/schedule/ring_job.h"
#include "tests/support/recording_sink.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(LayerChain, RoutesUsedAgainDoNotDependOnThreadsEither) {
  RunOptions options;
  options.strategy = "auto";
  options.extruded = true;
  options.layers = 60;
  options.threads = 1;
  const auto one = RunJob(options);
  options.threads = 8;
  const auto eight = RunJob(options);
  options.order = TestExecutor::Order::kNewestFirst;
  const auto newest_first = RunJob(options);

  ASSERT_EQ(one.size(), 60u);
  for (const auto& [index, outcome] : one) {
    EXPECT_EQ(outcome.route, eight.at(index).route) << "layer " << index;
    EXPECT_EQ(outcome.route, newest_first.at(index).route) << "layer " << index;
  }
}

// What strategies that use routes again are told.
struct Calls {
  std::mutex mutex;
  int solved = 0;
  int resumed = 0;
};

// Solves nothing, and notes what it is asked for.
class Counting : public Strategy {
 public:
  explicit Counting(Calls& calls) : Strategy({.reuses_routes = true}), calls_(calls) {}
  Solution Solve(const LayerProblem& problem, Budget&) const override {
    std::lock_guard<std::mutex> lock(calls_.mutex);
    ++calls_.solved;
    return Solution{GivenRoute(*problem.plan), StopReason::kLocalOptimum, std::nullopt};
  }
  Solution Resume(const LayerProblem&, const Route& start, Budget&) const override {
    std::lock_guard<std::mutex> lock(calls_.mutex);
    ++calls_.resumed;
    return Solution{start, StopReason::kLocalOptimum, std::nullopt};
  }

 private:
  Calls& calls_;
};

TEST(LayerChain, EqualAndMovedLayersStartFromARouteFoundBefore) {
  Calls calls;
  RecordingSink sink;
  TestExecutor executor(4);
  auto job = Job::Start(JobSpec(), std::make_unique<Counting>(calls), executor, sink);
  for (int i = 0; i < 50; ++i) job->Add({Moved(RingLayer(5, i % 2), 0.01 * i), {}, {}});
  job->Close();
  sink.Wait();

  EXPECT_EQ(sink.outcomes.size(), 50u);
  EXPECT_EQ(calls.solved, 2);
  EXPECT_GT(calls.resumed, 0);
}

TEST(LayerChain, WhatWasSearchedInVainFromTheSameStartIsNotSearchedAgain) {
  Calls calls;
  RecordingSink sink;
  TestExecutor executor(4);
  auto job = Job::Start(JobSpec(), std::make_unique<Counting>(calls), executor, sink);
  for (int i = 0; i < 100; ++i) job->Add({RingLayer(5, i % 2), {}, {}});
  job->Close();
  sink.Wait();

  EXPECT_EQ(sink.outcomes.size(), 100u);
  EXPECT_EQ(calls.solved, 2);
  EXPECT_LT(calls.resumed, 40);
}

TEST(LayerChain, LayersOfAnotherCostHaveRoutesOfTheirOwn) {
  Calls calls;
  RecordingSink sink;
  TestExecutor executor(4);
  auto job = Job::Start(JobSpec(), std::make_unique<Counting>(calls), executor, sink);
  CostSpec time;
  time.kind = CostSpec::Kind::kTime;
  for (int i = 0; i < 20; ++i) {
    job->Add({RingLayer(5, 0), {}, i % 2 == 0 ? CostSpec() : time});
  }
  job->Close();
  sink.Wait();

  EXPECT_EQ(calls.solved, 2);
}

// Says that the given order is optimal, for every layer.
class Proving : public Strategy {
 public:
  Proving() : Strategy({.reuses_routes = true}) {}
  Solution Solve(const LayerProblem& problem, Budget&) const override {
    const Route route = GivenRoute(*problem.plan);
    return Solution{route, StopReason::kLocalOptimum, RouteCost(problem, route)};
  }
};

// Layers are equal that differ by no more than is rounded away when they are compared: here the
// last 50 from the first 50.
std::vector<LayerOutcome> OutcomesOfAlmostEqualLayers(std::unique_ptr<Strategy> strategy) {
  RecordingSink sink;
  TestExecutor executor(1);
  auto job = Job::Start(JobSpec(), std::move(strategy), executor, sink);
  for (int i = 0; i < 100; ++i) {
    IslandPaths row;
    for (int k = 0; k < 6; ++k) {
      const double shrink_mm = k % 2 == 1 && i >= 50 ? 4e-5 : 0;
      row.contours.push_back(MakeContour({{10.0 * k - shrink_mm, 0}}));
    }
    job->Add({SequentialPlan({row}), Point{0, 0}, std::nullopt});
  }
  job->Close();
  sink.Wait();
  return std::move(sink.outcomes);
}

TEST(LayerChain, ABoundTakenOverHoldsForLayersThatDifferALittle) {
  const std::vector<LayerOutcome> outcomes =
      OutcomesOfAlmostEqualLayers(std::make_unique<Proving>());

  ASSERT_EQ(outcomes.size(), 100u);
  for (const LayerOutcome& outcome : outcomes) {
    ASSERT_TRUE(outcome.lower_bound.has_value());
    EXPECT_LE(*outcome.lower_bound, outcome.cost + 1e-9) << "layer " << outcome.index;
    EXPECT_GT(*outcome.lower_bound, 0.99 * outcome.cost);
  }
}

// As Proving, and in as many words.
class ProvingOptimal : public Proving {
 public:
  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    Solution solution = Proving::Solve(problem, budget);
    solution.stop = StopReason::kOptimal;
    return solution;
  }
};

// A bound taken over is a little below the cost: what is optimal there is not proven so here.
TEST(LayerChain, WhatIsCalledOptimalIsProvenForTheVeryLayer) {
  const std::vector<LayerOutcome> outcomes =
      OutcomesOfAlmostEqualLayers(std::make_unique<ProvingOptimal>());

  ASSERT_EQ(outcomes.size(), 100u);
  for (const LayerOutcome& outcome : outcomes) {
    ASSERT_TRUE(outcome.lower_bound.has_value());
    if (outcome.stop != StopReason::kOptimal) continue;
    EXPECT_NEAR(*outcome.lower_bound, outcome.cost, 1e-9) << "layer " << outcome.index;
  }
}

}  // namespace
}  // namespace traverse
