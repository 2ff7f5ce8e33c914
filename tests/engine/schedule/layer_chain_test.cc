#include "engine/schedule/layer_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "tests/support/recording_sink.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

// `count` contours of four vertices each on a ring, and a raster; every layer is turned a bit.
Plan RingLayer(int count, double turn) {
  IslandPaths island;
  for (int i = 0; i < count; ++i) {
    const double angle = turn + 2.4 * i;
    const Point c{50 + 30 * std::cos(angle), 50 + (20 + i) * std::sin(angle)};
    island.contours.push_back(
        MakeContour({{c.x, c.y}, {c.x + 3, c.y}, {c.x + 3, c.y + 3}, {c.x, c.y + 3}}));
    island.rasters.push_back(MakeOpenPath({c.x + 1, c.y + 1}, {c.x + 2, c.y + 2}));
  }
  return SequentialPlan({std::move(island)});
}

struct RunOptions {
  JobSpec spec;
  std::string strategy = "ni2opt";
  int layers = 12;
  int threads = 4;
  TestExecutor::Order order = TestExecutor::Order::kOldestFirst;
  std::map<int, Point> starts;
  bool extruded = false;  // two layers in turn, each a bit to the right of the last one
};

Plan Moved(Plan plan, double dx_mm) {
  for (Path& path : plan.paths) {
    for (Point& point : path.points) point.x += dx_mm;
  }
  return plan;
}

std::map<uint64_t, LayerOutcome> RunJob(const RunOptions& options) {
  RecordingSink sink;
  TestExecutor executor(options.threads, options.order);
  auto strategy = MakeStrategy(options.strategy, {});
  EXPECT_TRUE(strategy.ok()) << strategy.status();
  auto job = Job::Start(options.spec, *std::move(strategy), executor, sink);
  for (int i = 0; i < options.layers; ++i) {
    JobLayer layer;
    layer.plan =
        options.extruded ? Moved(RingLayer(12, i % 2), 0.01 * i) : RingLayer(3 + i % 4, 0.3 * i);
    const auto start = options.starts.find(i);
    if (start != options.starts.end()) layer.start = start->second;
    job->Add(std::move(layer));
  }
  job->Close();
  sink.Wait();
  EXPECT_EQ(job->pending(), 0);
  return sink.ByIndex();
}

TEST(LayerChain, EachLayerStartsWhereTheOneBeforeEnded) {
  RunOptions options;
  options.spec.start = {7, 7};

  const auto outcomes = RunJob(options);

  ASSERT_EQ(outcomes.size(), 12u);
  Point at{7, 7};
  for (const auto& [index, outcome] : outcomes) {
    EXPECT_EQ(outcome.start, at) << "layer " << index;
    at = RouteEnd(outcome.plan, outcome.route, outcome.start);
    EXPECT_EQ(outcome.end, at);
    EXPECT_TRUE(outcome.invalid_route.empty());
    EXPECT_LE(outcome.cost, outcome.cost_given + 100);
  }
}

// From the start that a layer had in the end: a bound for a predicted one would not be one.
TEST(LayerChain, BoundsLayersForStrategiesThatWantIt) {
  RunOptions options;
  options.strategy = "auto";
  options.spec.cleaning = CleaningSpec{{90, 90}, 3, 0};
  const auto strategy = *MakeStrategy("exact", {});

  for (const auto& [index, outcome] : RunJob(options)) {
    SCOPED_TRACE(absl::StrCat("layer ", index));
    LayerProblem problem;
    problem.plan = &outcome.plan;
    problem.start = outcome.start;
    Budget budget;
    const Solution proven = strategy->Solve(problem, budget);
    ASSERT_EQ(proven.stop, StopReason::kOptimal);
    ASSERT_TRUE(outcome.lower_bound.has_value());
    EXPECT_GT(*outcome.lower_bound, 0.5 * outcome.cost);
    EXPECT_LE(*outcome.lower_bound, outcome.cost + 1e-9);
    if (outcome.cleaning_mm == 0) {
      EXPECT_LE(*outcome.lower_bound, RouteCost(problem, proven.route) + 1e-6);
    }
  }
}

TEST(LayerChain, RoutesDoNotDependOnThreadsOrTheOrderOfTasks) {
  RunOptions options;
  options.threads = 1;
  const auto one = RunJob(options);
  options.threads = 8;
  const auto eight = RunJob(options);
  options.order = TestExecutor::Order::kNewestFirst;
  const auto newest_first = RunJob(options);

  ASSERT_EQ(one.size(), eight.size());
  for (const auto& [index, outcome] : one) {
    EXPECT_EQ(outcome.route, eight.at(index).route) << "layer " << index;
    EXPECT_EQ(outcome.route, newest_first.at(index).route) << "layer " << index;
  }
}

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

// Equal layers may differ by what is rounded away when they are compared.
TEST(LayerChain, ABoundTakenOverHoldsForLayersThatDifferALittle) {
  RecordingSink sink;
  TestExecutor executor(1);
  auto job = Job::Start(JobSpec(), std::make_unique<Proving>(), executor, sink);
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

  ASSERT_EQ(sink.outcomes.size(), 100u);
  for (const LayerOutcome& outcome : sink.outcomes) {
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
  RecordingSink sink;
  TestExecutor executor(1);
  auto job = Job::Start(JobSpec(), std::make_unique<ProvingOptimal>(), executor, sink);
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

  ASSERT_EQ(sink.outcomes.size(), 100u);
  for (const LayerOutcome& outcome : sink.outcomes) {
    ASSERT_TRUE(outcome.lower_bound.has_value());
    if (outcome.stop != StopReason::kOptimal) continue;
    EXPECT_NEAR(*outcome.lower_bound, outcome.cost, 1e-9) << "layer " << outcome.index;
  }
}

TEST(LayerChain, AQuickStrategySolvesEveryLayerFromItsTrueStart) {
  RunOptions options;
  options.layers = 80;
  const auto strategy = *MakeStrategy("ni2opt", {});

  for (const auto& [index, outcome] : RunJob(options)) {
    const LayerProblem problem{&outcome.plan, outcome.start, std::nullopt, CostSpec(),
                               StreamSeed(options.spec.seed, index)};
    Budget budget;
    EXPECT_EQ(outcome.route, strategy->Solve(problem, budget).route) << "layer " << index;
  }
}

TEST(EndHistory, GivesTheLastEndOfAnEqualLayerAboveAllFromTheSameStart) {
  const auto make = [](const Plan& plan) { return FingerprintOf(plan, {}).shape; };
  const uint64_t ring = make(RingLayer(3, 0.1));
  const uint64_t other = make(RingLayer(3, 0.2));
  EndHistory history;
  history.Learn(ring, 11, {1, 1});
  history.Learn(other, 12, {2, 2});
  history.Learn(ring, 13, {3, 3});

  EXPECT_EQ(history.EndOf(ring, 11), (Point{1, 1}));
  EXPECT_EQ(history.EndOf(ring, 14), (Point{3, 3}));
  EXPECT_EQ(history.EndOf(make(RingLayer(4, 0.1)), 14), std::nullopt);
  EXPECT_EQ(history.EndOf(make(Moved(RingLayer(3, 0.2), 5)), 14), (Point{2, 2}));
}

TEST(LayerFingerprint, TellsLayersThatWereMovedFromOthers) {
  const LayerFingerprint ring = FingerprintOf(RingLayer(3, 0.1), {});
  const LayerFingerprint moved = FingerprintOf(Moved(RingLayer(3, 0.1), 5), {});

  EXPECT_EQ(FingerprintOf(RingLayer(3, 0.1), {}).exact, ring.exact);
  EXPECT_EQ(moved.shape, ring.shape);
  CostSpec time;
  time.kind = CostSpec::Kind::kTime;
  EXPECT_NE(FingerprintOf(RingLayer(3, 0.1), time).shape, ring.shape);
  EXPECT_NE(moved.exact, ring.exact);
  EXPECT_EQ(ProblemKey(7, {0, 0}, {1, 2}, std::nullopt),
            ProblemKey(7, {5, 5}, {6, 7}, std::nullopt));
  EXPECT_NE(ProblemKey(7, {0, 0}, {1, 2}, std::nullopt),
            ProblemKey(7, {0, 0}, {1, 2.1}, std::nullopt));
  EXPECT_NE(ProblemKey(7, {0, 0}, {1, 2}, Point{0, 0}),
            ProblemKey(7, {0, 0}, {1, 2}, std::nullopt));
}

TEST(LayerChain, NoneReturnsTheGivenOrderAndItsTravel) {
  RunOptions options;
  options.strategy = "none";

  for (const auto& [index, outcome] : RunJob(options)) {
    EXPECT_EQ(outcome.route, GivenRoute(outcome.plan)) << "layer " << index;
    EXPECT_DOUBLE_EQ(outcome.travel.total_mm(), outcome.given.total_mm());
    EXPECT_DOUBLE_EQ(outcome.cost, outcome.cost_given);
  }
}

TEST(LayerChain, CleansAfterEveryNLayersButNotAfterTheLast) {
  RunOptions options;
  options.layers = 6;
  options.spec.cleaning = CleaningSpec{{100, 0}, 2, 0};

  const auto outcomes = RunJob(options);

  for (const auto& [index, outcome] : outcomes) {
    const bool cleaned = index == 1 || index == 3;
    EXPECT_EQ(outcome.cleaning_mm > 0, cleaned) << "layer " << index;
    if (cleaned) {
      EXPECT_DOUBLE_EQ(outcome.cleaning_mm, Distance(outcome.end, {100, 0}));
      EXPECT_EQ(outcomes.at(index + 1).start, (Point{100, 0}));
    }
  }
}

TEST(LayerChain, CountsLayersSinceTheLastCleaning) {
  RunOptions options;
  options.layers = 4;
  options.spec.cleaning = CleaningSpec{{100, 0}, 3, 2};

  const auto outcomes = RunJob(options);

  EXPECT_EQ(outcomes.at(1).start, (Point{100, 0}));
  EXPECT_NE(outcomes.at(2).start, (Point{100, 0}));
}

TEST(LayerChain, AGivenStartWins) {
  RunOptions options;
  options.starts = {{0, {1, 2}}, {5, {3, 4}}};

  const auto outcomes = RunJob(options);

  EXPECT_EQ(outcomes.at(0).start, (Point{1, 2}));
  EXPECT_EQ(outcomes.at(5).start, (Point{3, 4}));
  EXPECT_EQ(outcomes.at(6).start, outcomes.at(5).end);
}

TEST(LayerChain, APastDeadlineStillAnswersEveryLayer) {
  RunOptions options;
  options.spec.deadline = Budget::Clock::now() - std::chrono::seconds(1);

  const auto outcomes = RunJob(options);

  ASSERT_EQ(outcomes.size(), 12u);
  for (const auto& [index, outcome] : outcomes) {
    EXPECT_EQ(outcome.stop, StopReason::kTimeLimit) << "layer " << index;
    EXPECT_EQ(outcome.route.size(), outcome.plan.paths.size());
  }
}

// Uses all the time it is given, and notes how much that is.
class Greedier : public Strategy {
 public:
  explicit Greedier(Calls& calls) : calls_(calls) {}
  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const bool has_time = budget.deadline() > Budget::Clock::now();
    while (!budget.ExhaustedNow()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::lock_guard<std::mutex> lock(calls_.mutex);
    calls_.solved += has_time;
    return Solution{GivenRoute(*problem.plan), StopReason::kTimeLimit, std::nullopt};
  }

 private:
  Calls& calls_;
};

TEST(LayerChain, NoLayerTakesTheTimeOfThoseAfterIt) {
  Calls calls;
  RecordingSink sink;
  TestExecutor executor(2);
  JobSpec spec;
  spec.deadline = Budget::Clock::now() + std::chrono::milliseconds(500);
  auto job = Job::Start(spec, std::make_unique<Greedier>(calls), executor, sink);
  for (int i = 0; i < 10; ++i) job->Add({RingLayer(5, i), Point{}, {}});
  job->Close();
  sink.Wait();

  EXPECT_EQ(sink.outcomes.size(), 10u);
  EXPECT_EQ(calls.solved, 10);
}

TEST(LayerChain, AJobWithoutLayersIsDone) {
  RunOptions options;
  options.layers = 0;

  EXPECT_TRUE(RunJob(options).empty());
}

// A strategy that is wrong: it leaves the last path out.
class Forgetful : public Strategy {
 public:
  Solution Solve(const LayerProblem& problem, Budget&) const override {
    Solution solution{GivenRoute(*problem.plan), StopReason::kLocalOptimum, std::nullopt};
    solution.route.pop_back();
    return solution;
  }
  Solution Resume(const LayerProblem& problem, const Route&, Budget& budget) const override {
    return Solve(problem, budget);
  }
};

TEST(LayerChain, ReplacesAnInvalidRouteByTheGivenOrder) {
  RecordingSink sink;
  TestExecutor executor(2);
  auto job = Job::Start(JobSpec(), std::make_unique<Forgetful>(), executor, sink);
  job->Add({RingLayer(3, 0), std::nullopt, std::nullopt});
  job->Close();
  sink.Wait();

  ASSERT_EQ(sink.outcomes.size(), 1u);
  EXPECT_FALSE(sink.outcomes[0].invalid_route.empty());
  EXPECT_EQ(sink.outcomes[0].route, GivenRoute(sink.outcomes[0].plan));
}

// A strategy whose routes suit the predicted start alone: from another one it has nothing to add.
class Stubborn : public Strategy {
 public:
  Solution Solve(const LayerProblem& problem, Budget&) const override {
    Route route = GivenRoute(*problem.plan);
    std::reverse(route.begin(), route.end());
    return Solution{route, StopReason::kLocalOptimum, std::nullopt};
  }
  Solution Resume(const LayerProblem&, const Route& start, Budget&) const override {
    return Solution{start, StopReason::kLocalOptimum, std::nullopt};
  }
};

TEST(LayerChain, IsNeverWorseThanGreedyFromTheTrueStart) {
  IslandPaths row;
  for (int i = 0; i < 6; ++i) row.contours.push_back(MakeContour({{10.0 * i, 5}}));
  RecordingSink sink;
  TestExecutor executor(1);
  auto job = Job::Start(JobSpec(), std::make_unique<Stubborn>(), executor, sink);
  for (int i = 0; i < 3; ++i) job->Add({SequentialPlan({row}), std::nullopt, std::nullopt});
  job->Close();
  sink.Wait();

  Budget budget;
  for (const LayerOutcome& outcome : sink.outcomes) {
    const LayerProblem problem{&outcome.plan, outcome.start, std::nullopt, CostSpec(), 1};
    const Route greedy = (*MakeStrategy("greedy", {}))->Solve(problem, budget).route;
    EXPECT_LE(outcome.cost, RouteCost(problem, greedy) + 1e-9) << "layer " << outcome.index;
  }
}

// A strategy that works until it is cancelled.
class Endless : public Strategy {
 public:
  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    while (!budget.ExhaustedNow()) std::this_thread::yield();
    return Solution{GivenRoute(*problem.plan), StopReason::kCancelled, std::nullopt};
  }
};

// The best of five: others may be using the machine too.
TEST(LayerChain, CancelEndsTheJobWithin50Milliseconds) {
  double least_seconds = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < 5; ++attempt) {
    RecordingSink sink;
    TestExecutor executor(2);
    auto job = Job::Start(JobSpec(), std::make_unique<Endless>(), executor, sink);
    for (int i = 0; i < 100; ++i) job->Add({RingLayer(3, i), std::nullopt, std::nullopt});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));

    const Stopwatch watch;
    job->Cancel();
    job->Cancel();
    sink.Wait();

    least_seconds = std::min(least_seconds, watch.Seconds());
    EXPECT_TRUE(sink.outcomes.empty());
  }
  EXPECT_LT(least_seconds, 0.05);
}

TEST(LayerChain, ALayerBeforeACleaningWaitsForTheNextOneOrTheEnd) {
  RecordingSink sink;
  TestExecutor executor(1);
  JobSpec spec;
  spec.cleaning = CleaningSpec{{0, 0}, 1, 0};
  auto job = Job::Start(spec, *MakeStrategy("none", {}), executor, sink);

  job->Add({RingLayer(1, 0), std::nullopt, std::nullopt});
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(job->pending(), 1);
  job->Close();
  sink.Wait();

  EXPECT_EQ(sink.outcomes.size(), 1u);
  EXPECT_EQ(sink.outcomes[0].cleaning_mm, 0);
}

}  // namespace
}  // namespace traverse
