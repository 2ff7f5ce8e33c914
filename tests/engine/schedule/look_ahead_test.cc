// The chain where layers are ended with a view to the next one.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/model/layers_in_order.h"
#include "engine/schedule/layer_chain.h"
#include "engine/strategy/registry.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/recording_sink.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using testing::BruteForce;
using testing::RandomPlan;
using testing::RandomPlanOptions;

Plan PointsOnALine(const std::vector<double>& places) {
  IslandPaths island;
  for (const double x : places) island.contours.push_back(MakeContour({{x, 0}}));
  return SequentialPlan({std::move(island)});
}

// From 0 it is shorter to end at -10.5, by 0.5, which greedy does not see; the next layer begins at
// 12.
Plan BothSides() { return PointsOnALine({-1, 10, -10.5}); }
Plan RightSide() { return PointsOnALine({12, 20, 30}); }

struct Options {
  JobSpec spec = {};
  bool more_follows = true;
  std::string strategy = "auto";
  int threads = 4;
  TestExecutor::Order order = TestExecutor::Order::kOldestFirst;
  std::chrono::milliseconds pause{0};  // before each layer and the end
};

std::map<uint64_t, LayerOutcome> RunJob(const std::vector<JobLayer>& layers,
                                        const Options& options) {
  RecordingSink sink;
  TestExecutor executor(options.threads, options.order);
  auto job = Job::Start(options.spec, *MakeStrategy(options.strategy, {}), executor, sink);
  for (JobLayer layer : layers) {
    layer.more_follows = options.more_follows;
    std::this_thread::sleep_for(options.pause);
    job->Add(std::move(layer));
  }
  std::this_thread::sleep_for(options.pause);
  job->Close();
  sink.Wait();
  return sink.ByIndex();
}

std::vector<JobLayer> RandomLayers(uint64_t seed, int count,
                                   const RandomPlanOptions& options = {.max_paths = 9}) {
  std::vector<JobLayer> layers;
  for (int i = 0; i < count; ++i) {
    // Every third is one of two that repeat.
    const uint64_t plan =
        i % 3 == 2 ? static_cast<uint64_t>(i) : 1000 + static_cast<uint64_t>(i % 2);
    layers.push_back({RandomPlan(100 * seed + plan, options), {}, {}});
  }
  return layers;
}

double Total(const std::map<uint64_t, LayerOutcome>& outcomes) {
  double sum = 0;
  for (const auto& [index, outcome] : outcomes) sum += outcome.cost + outcome.cleaning_mm;
  return sum;
}

TEST(LookAhead, EndsALayerWhereTheNextOneIsCheapToBegin) {
  const std::vector<JobLayer> layers = {{BothSides(), {}, {}}, {RightSide(), {}, {}}};

  const auto blind = RunJob(layers, {.more_follows = false});
  const auto seeing = RunJob(layers, {.more_follows = true});

  EXPECT_EQ(blind.at(0).end, (Point{-10.5, 0}));
  EXPECT_DOUBLE_EQ(blind.at(0).cost, 30.5);
  EXPECT_EQ(blind.at(0).stop, StopReason::kOptimal);
  EXPECT_EQ(seeing.at(0).end, (Point{10, 0}));
  EXPECT_DOUBLE_EQ(Total(seeing), 31 + 20);
  EXPECT_LT(Total(seeing), Total(blind));
}

// What is proven of a layer is proven of it alone.
TEST(LookAhead, DoesNotCallARouteOptimalThatEndsElsewhereForTheNextLayer) {
  const auto outcomes = RunJob({{BothSides(), {}, {}}, {RightSide(), {}, {}}}, {});

  EXPECT_DOUBLE_EQ(outcomes.at(0).cost, 31);
  ASSERT_TRUE(outcomes.at(0).lower_bound.has_value());
  EXPECT_NEAR(*outcomes.at(0).lower_bound, 30.5, 1e-9);
  EXPECT_EQ(outcomes.at(0).stop, StopReason::kLocalOptimum);
  EXPECT_EQ(outcomes.at(1).stop, StopReason::kOptimal);
}

TEST(LookAhead, BoundsAndProofsHoldForEachLayerAlone) {
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    std::vector<JobLayer> layers;
    for (uint64_t i = 0; i < 4; ++i) {
      layers.push_back({RandomPlan(10 * seed + i, {.max_paths = 6}), {}, {}});
    }
    for (const auto& [index, outcome] : RunJob(layers, {})) {
      EXPECT_TRUE(outcome.invalid_route.empty()) << outcome.invalid_route;
      const LayerProblem problem{&outcome.plan, outcome.start, std::nullopt, CostSpec(), 1};
      const double least = BruteForce(problem).cost;
      EXPECT_LE(outcome.lower_bound.value_or(0), least + 1e-6) << "layer " << index;
      if (outcome.stop != StopReason::kOptimal) continue;
      EXPECT_NEAR(outcome.cost, least, 1e-6) << "layer " << index;
    }
  }
}

// Of jobs whose layers are all in view of the first one.
TEST(LookAhead, MakesNoJobLongerThanGreedyOrThanOneLayerAfterTheOther) {
  int dearer_than_need_be = 0;
  int shorter = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    std::vector<JobLayer> layers;
    for (uint64_t i = 0; i < 5; ++i) {
      layers.push_back({RandomPlan(10 * seed + i, {.max_paths = 9}), {}, {}});
    }

    const auto outcomes = RunJob(layers, {});
    const double seeing = Total(outcomes);
    const double blind = Total(RunJob(layers, {.more_follows = false}));

    EXPECT_LE(seeing, Total(RunJob(layers, {.strategy = "greedy"})) + 1e-6);
    EXPECT_LE(seeing, blind + 1e-6);
    shorter += seeing < blind - 1e-3 ? 1 : 0;
    for (const auto& [index, outcome] : outcomes) {
      dearer_than_need_be += outcome.lower_bound.value_or(outcome.cost) < outcome.cost - 1e-3;
    }
  }
  EXPECT_GT(shorter, 10);
  EXPECT_GT(dearer_than_need_be, 5);
}

// From 0, greedy does 1 and then -2, for 4, and the next layer is 42 from there. The other way
// round the first layer costs 5, and the next one 39.
TEST(LookAhead, LetsALayerCostMoreThanGreedyDoesForTheSakeOfTheNext) {
  const auto outcomes =
      RunJob({{PointsOnALine({1, -2}), {}, {}}, {PointsOnALine({2, 40}), {}, {}}}, {});

  EXPECT_DOUBLE_EQ(outcomes.at(0).cost, 5);
  EXPECT_DOUBLE_EQ(Total(outcomes), 5 + 39);
}

// What is best for the second layer alone is dear for the third one.
TEST(LookAhead, SeesMoreThanTheNextLayer) {
  std::vector<JobLayer> layers;
  for (const std::vector<double>& places :
       {std::vector<double>{1, -1}, {2, -2.1}, {3, -3.2}, {4, -4.3}, {30, 40}}) {
    layers.push_back({PointsOnALine(places), {}, {}});
  }
  std::vector<const Plan*> all;
  for (const JobLayer& layer : layers) all.push_back(&layer.plan);
  const Plan joined = PlanInOrder(all);
  const LayerProblem together{&joined, {0, 0}, std::nullopt, CostSpec(), 1};

  EXPECT_NEAR(Total(RunJob(layers, {})), BruteForce(together).cost, 1e-9);
}

// Octagons on a grid, every second column moved by half a step.
Plan HexagonalGrid(int columns, int rows) {
  IslandPaths island;
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const double x = 10 * i + (j % 2 == 0 ? 0 : 5);
      std::vector<Point> corners;
      for (int k = 0; k < 8; ++k) {
        corners.push_back({x + 3 * std::cos(k * M_PI / 4), 8.66 * j + 3 * std::sin(k * M_PI / 4)});
      }
      island.contours.push_back(MakeContour(std::move(corners)));
    }
  }
  return SequentialPlan({std::move(island)});
}

// Where many routes are of equal length, a search over both layers, begun with a route of the
// second one for another start, used to end 1.2 to 1.8 % above one layer after the other.
TEST(LookAhead, IsNeverLongerThanOneLayerAfterTheOtherOnHexagonalGrids) {
  for (const auto& [columns, rows] : {std::pair(8, 3), {5, 6}, {3, 9}, {5, 5}}) {
    SCOPED_TRACE(absl::StrCat(columns, " x ", rows));
    const std::vector<JobLayer> layers = {{HexagonalGrid(columns, rows), {}, {}},
                                          {HexagonalGrid(columns, rows), {}, {}}};

    const double blind = Total(RunJob(layers, {.more_follows = false}));
    const double seeing = Total(RunJob(layers, {.more_follows = true}));

    EXPECT_LE(seeing, blind + 1e-6);
  }
}

TEST(LookAhead, SavesTravelOverManyJobs) {
  double blind = 0;
  double seeing = 0;
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<JobLayer> layers = RandomLayers(
        seed, 12, {.shape = testing::PlanShape::kSequential, .min_paths = 4, .max_paths = 12});
    blind += Total(RunJob(layers, {.more_follows = false}));
    seeing += Total(RunJob(layers, {.more_follows = true}));
  }

  EXPECT_LT(seeing, 0.98 * blind);
}

TEST(LookAhead, RoutesDependNeitherOnThreadsNorOnWhenLayersCome) {
  const std::vector<JobLayer> layers = RandomLayers(1, 14);
  for (const bool cleaning : {false, true}) {
    Options options;
    if (cleaning) options.spec.cleaning = CleaningSpec{{50, 50}, 5, 0};
    options.threads = 1;
    const auto one = RunJob(layers, options);
    options.threads = 8;
    const auto eight = RunJob(layers, options);
    options.order = TestExecutor::Order::kNewestFirst;
    const auto newest_first = RunJob(layers, options);
    options.pause = std::chrono::milliseconds(1);
    const auto slow = RunJob(layers, options);

    ASSERT_EQ(one.size(), 14u);
    for (const auto& [index, outcome] : one) {
      EXPECT_EQ(outcome.route, eight.at(index).route) << "layer " << index;
      EXPECT_EQ(outcome.route, newest_first.at(index).route) << "layer " << index;
      EXPECT_EQ(outcome.route, slow.at(index).route) << "layer " << index;
      EXPECT_EQ(outcome.stop, slow.at(index).stop) << "layer " << index;
      EXPECT_EQ(outcome.lower_bound, slow.at(index).lower_bound) << "layer " << index;
      EXPECT_TRUE(outcome.invalid_route.empty()) << outcome.invalid_route;
    }
  }
}

// A caller who sends the next layer only after an answer.
TEST(LookAhead, ALayerWithNothingSaidToFollowIsAnsweredAtOnce) {
  RecordingSink sink;
  TestExecutor executor(2);
  auto job = Job::Start(JobSpec(), *MakeStrategy("auto", {}), executor, sink);

  for (size_t i = 0; i < 5; ++i) {
    job->Add({i % 2 == 0 ? BothSides() : RightSide(), {}, {}});
    ASSERT_TRUE(sink.WaitForAnswers(i + 1)) << "layer " << i;
  }
  job->Close();
  sink.Wait();
}

TEST(LookAhead, ALayerWaitsForWhatIsSaidToFollow) {
  RecordingSink sink;
  TestExecutor executor(2);
  auto job = Job::Start(JobSpec(), *MakeStrategy("auto", {}), executor, sink);
  job->Add({BothSides(), {}, {}, true});
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(job->pending(), 1);

  job->Add({RightSide(), {}, {}, true});
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(job->pending(), 2);

  job->Close();
  sink.Wait();
  EXPECT_EQ(sink.ByIndex().at(0).end, (Point{10, 0}));
}

TEST(LookAhead, ALayerWaitsForNoMoreThanItsView) {
  RecordingSink sink;
  TestExecutor executor(2);
  auto job = Job::Start(JobSpec(), *MakeStrategy("auto", {}), executor, sink);
  job->Add({BothSides(), {}, {}, true});
  for (size_t i = 0; i < LayerSolver::kMostInView; ++i) job->Add({RightSide(), {}, {}, true});
  ASSERT_TRUE(sink.WaitForAnswers(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(job->pending(), static_cast<int64_t>(LayerSolver::kMostInView));

  // Of this layer and the one before it there are more paths than more than two may have.
  job->Add({PointsOnALine(std::vector<double>(140, 1)), {}, {}, true});
  for (size_t i = 0; i < LayerSolver::kMostInView; ++i) job->Add({RightSide(), {}, {}, true});
  ASSERT_TRUE(sink.WaitForAnswers(1 + LayerSolver::kMostInView));
  job->Cancel();
  sink.Wait();
}

TEST(LookAhead, DoesNotWaitWhereTheNextLayerDoesNotMatter) {
  RecordingSink sink;
  TestExecutor executor(2);
  JobSpec spec = {};
  spec.start = {1, 0};
  auto job = Job::Start(spec, *MakeStrategy("auto", {}), executor, sink);
  job->Add({BothSides(), {}, {}, true});
  // It begins at a place of its own, and is held up itself.
  job->Add({RightSide(), Point{0, 0}, {}, true});

  EXPECT_TRUE(sink.WaitForAnswers(1));
  job->Cancel();
  sink.Wait();
}

TEST(LookAhead, TakesThePlaceOfNoTimeWhereThereIsNoNextLayer) {
  Options options;
  options.spec.layer_time_limit = absl::Milliseconds(100);

  const auto outcomes = RunJob({{BothSides(), {}, {}}}, options);

  EXPECT_EQ(outcomes.at(0).stop, StopReason::kOptimal);
  EXPECT_EQ(outcomes.at(0).end, (Point{-10.5, 0}));
}

}  // namespace
}  // namespace traverse
