#include "engine/schedule/chain_bound.h"

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/engine.h"
#include "engine/model/layers_in_order.h"
#include "engine/strategy/registry.h"
#include "tests/engine/schedule/ring_job.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/processor_watch.h"
#include "tests/support/recording_sink.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using testing::BruteForce;
using testing::RandomPlan;
using testing::RingLayer;

struct JobAnswer {
  double cost = 0;         // of all layers, without moves to the cleaning point
  double cleaning_mm = 0;  // those
  std::optional<double> chain_bound;
};

JobAnswer Answer(const std::string& strategy, const std::vector<JobLayer>& layers,
                 const JobSpec& spec = {}, bool bounds_chain = true) {
  RecordingSink sink;
  TestExecutor executor(2, TestExecutor::Order::kOldestFirst);
  std::map<std::string, std::string> options;
  if (bounds_chain) options["chain_bound"] = "true";
  auto job = Job::Start(spec, *MakeStrategy(strategy, options), executor, sink);
  for (const JobLayer& layer : layers) job->Add(layer);
  job->Close();
  sink.Wait();
  JobAnswer answer{0, 0, sink.chain_bound};
  for (const LayerOutcome& outcome : sink.outcomes) {
    answer.cost += outcome.cost;
    answer.cleaning_mm += outcome.cleaning_mm;
  }
  return answer;
}

JobLayer LayerOf(Plan plan) { return JobLayer{std::move(plan), {}, {}}; }

std::vector<JobLayer> TinyLayers(uint64_t seed) {
  std::vector<JobLayer> layers;
  for (uint64_t i = 0; i < 2 + seed % 2; ++i) {
    layers.push_back(LayerOf(RandomPlan(10 * seed + i, {.max_paths = seed % 2 == 0 ? 4 : 3})));
  }
  return layers;
}

// Of all routes of the layers together.
double Optimum(const std::vector<JobLayer>& layers, const CostSpec& cost, Point start,
               std::optional<Point> finish = std::nullopt) {
  std::vector<const Plan*> plans;
  for (const JobLayer& layer : layers) plans.push_back(&layer.plan);
  const Plan all = PlanInOrder(plans);
  return BruteForce({&all, start, finish, cost, 1}).cost;
}

TEST(ChainBound, IsNeverAboveTheOptimumAndExactProvesIt) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const std::vector<JobLayer> layers = TinyLayers(seed);
    JobSpec spec;
    Rng rng(seed);
    spec.cost = testing::RandomCost(rng);
    const double best = Optimum(layers, spec.cost, spec.start);
    const double rounding = 1e-9 * (1 + best);

    const JobAnswer quick = Answer("auto", layers, spec);
    const JobAnswer proven = Answer("exact", layers, spec);

    ASSERT_TRUE(quick.chain_bound.has_value());
    EXPECT_LE(*quick.chain_bound, best + rounding);
    ASSERT_TRUE(proven.chain_bound.has_value());
    EXPECT_NEAR(*proven.chain_bound, best, rounding);
    EXPECT_LE(*proven.chain_bound, proven.cost + rounding);
  }
}

// Alone, the first layer ends on the left, at 30.5, and the second one costs 40.5 from there. If
// the first one ends on the right, at 31, both cost 51.
TEST(ChainBound, HoldsWhereverALayerEnds) {
  const auto points = [](const std::vector<double>& places) {
    IslandPaths island;
    for (const double x : places) island.contours.push_back(MakeContour({{x, 0}}));
    return LayerOf(SequentialPlan({std::move(island)}));
  };

  const JobAnswer answer = Answer("exact", {points({-1, 10, -10.5}), points({12, 20, 30})});

  EXPECT_DOUBLE_EQ(answer.cost, 71);
  ASSERT_TRUE(answer.chain_bound.has_value());
  EXPECT_DOUBLE_EQ(*answer.chain_bound, 51);
}

TEST(ChainBound, IsCutWhereALayerBeginsAtAGivenPoint) {
  std::vector<JobLayer> layers = TinyLayers(1);
  ASSERT_EQ(layers.size(), 3u);
  layers[2].start = Point{40, 7};

  const JobAnswer answer = Answer("exact", layers);

  const double best = Optimum({layers[0], layers[1]}, CostSpec(), {0, 0}) +
                      Optimum({layers[2]}, CostSpec(), *layers[2].start);
  ASSERT_TRUE(answer.chain_bound.has_value());
  EXPECT_NEAR(*answer.chain_bound, best, 1e-9 * best);
}

TEST(ChainBound, CountsTheMoveToTheCleaningPointAsFound) {
  for (uint64_t seed = 1; seed <= 9; seed += 2) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const std::vector<JobLayer> layers = TinyLayers(seed);
    ASSERT_EQ(layers.size(), 3u);
    JobSpec spec;
    spec.cleaning = CleaningSpec{{-30, 50}, 2, 0};

    const JobAnswer answer = Answer("exact", layers, spec);

    const double best = Optimum({layers[0], layers[1]}, CostSpec(), {0, 0}, spec.cleaning->point) +
                        Optimum({layers[2]}, CostSpec(), spec.cleaning->point);
    ASSERT_TRUE(answer.chain_bound.has_value());
    EXPECT_NEAR(*answer.chain_bound + answer.cleaning_mm, best, 1e-9 * best);
  }
}

// Too many paths for brute force and for subsets: what proves it is branch and cut, of both layers.
TEST(ChainBound, IsProvenForLargerLayersToo) {
  const std::vector<JobLayer> layers = {LayerOf(RingLayer(14, 0)), LayerOf(RingLayer(14, 1))};

  const JobAnswer quick = Answer("auto", layers);
  const JobAnswer proven = Answer("exact", layers);

  ASSERT_TRUE(quick.chain_bound.has_value() && proven.chain_bound.has_value());
  EXPECT_LE(*quick.chain_bound, *proven.chain_bound * (1 + 1e-9));
  EXPECT_LE(*proven.chain_bound, quick.cost * (1 + 1e-9));
  EXPECT_GT(*proven.chain_bound, 0.98 * proven.cost);
}

TEST(ChainBound, IsUnsetUnlessAskedFor) {
  EXPECT_FALSE(Answer("exact", TinyLayers(1), {}, false).chain_bound.has_value());
  EXPECT_FALSE(Answer("auto", TinyLayers(1), {}, false).chain_bound.has_value());
}

TEST(ChainBound, OfAJobWithoutLayersIsUnset) {
  EXPECT_FALSE(Answer("exact", {}).chain_bound.has_value());
}

TEST(ChainBound, OfLayersWithoutPathsIsNothing) {
  EXPECT_EQ(Answer("exact", {LayerOf({}), LayerOf({})}).chain_bound, 0);
}

// Costs of one unit cannot be compared with those of another.
TEST(ChainBound, IsUnsetWhereCostsDiffer) {
  std::vector<JobLayer> layers = TinyLayers(1);
  layers[1].cost = CostSpec{.kind = CostSpec::Kind::kTime};

  EXPECT_FALSE(Answer("exact", layers).chain_bound.has_value());
}

TEST(ChainBound, IsUnsetForMorePointsThanAreKept) {
  ChainBound chain;
  Path path = MakeContour(std::vector<Point>(KeptPlans::kMostPoints, Point{1, 2}));
  const Plan plan = SequentialPlan({IslandPaths{{path}, {}}});
  const auto known = [](const LayerProblem&, const Route&, Budget&) {
    return std::optional<double>(0);
  };
  Budget budget;

  chain.Add(0, {plan, {{0, 0}}, {0, 0}, false, std::nullopt, CostSpec()});
  EXPECT_TRUE(chain.Compute(1, known, budget).has_value());
  chain.Add(1, {plan, {{0, 0}}, {0, 0}, true, std::nullopt, CostSpec()});
  EXPECT_FALSE(chain.Compute(1, known, budget).has_value());
}

TEST(ChainBound, EndsWithTheDeadlineOfTheJob) {
  std::vector<JobLayer> layers;
  for (int i = 0; i < 20; ++i) layers.push_back(LayerOf(RingLayer(30, i)));
  JobSpec spec;
  spec.deadline = Budget::Clock::now() + std::chrono::seconds(1);
  const testing::ProcessorWatch watch;

  Answer("exact", layers, spec);

  EXPECT_LT(watch.Seconds(), 4);
}

TEST(ChainBound, ACancelledJobHasNone) {
  RecordingSink sink;
  TestExecutor executor(2, TestExecutor::Order::kOldestFirst);
  auto job = Job::Start({}, *MakeStrategy("exact", {{"chain_bound", "true"}}), executor, sink);
  for (int i = 0; i < 4; ++i) job->Add(LayerOf(RingLayer(10, i)));

  job->Cancel();

  sink.Wait();
  EXPECT_FALSE(sink.chain_bound.has_value());
}

}  // namespace
}  // namespace traverse
