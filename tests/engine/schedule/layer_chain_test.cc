#include "engine/schedule/layer_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "tests/engine/schedule/ring_job.h"
#include "tests/support/processor_watch.h"
#include "tests/support/recording_sink.h"
#include "tests/support/step_clock.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

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

// Runs the waiting task of the lowest rank, the oldest of these, when it is told to.
class ByRank : public Executor {
 public:
  void Submit(std::function<void()> task) override { SubmitLarge(std::move(task), 0, 0); }
  void SubmitLarge(std::function<void()> task, int64_t /*points*/, uint64_t rank) override {
    tasks_.emplace(rank, std::move(task));
  }
  void Run() {
    while (!tasks_.empty()) {
      const std::function<void()> task = std::move(tasks_.begin()->second);
      tasks_.erase(tasks_.begin());
      task();
    }
  }

 private:
  std::multimap<uint64_t, std::function<void()>> tasks_;
};

// Counts the layers that it has solved.
class Counted : public Strategy {
 public:
  explicit Counted(int& solved) : solved_(solved) {}
  Solution Solve(const LayerProblem& problem, Budget& /*budget*/) const override {
    ++solved_;
    return Solution{GivenRoute(*problem.plan), StopReason::kLocalOptimum, std::nullopt};
  }

 private:
  int& solved_;
};

// The other layers wait for where it ends.
TEST(LayerChain, WantsALayerToBeAnsweredBeforeLaterOnesAreSolved) {
  struct Sink : JobSink {
    void OnLayer(LayerOutcome outcome) override { solved_at.emplace(outcome.index, solved); }
    void OnDone() override { done = true; }
    int solved = 0;
    bool done = false;
    std::map<uint64_t, int> solved_at;
  } sink;
  ByRank executor;
  auto job = Job::Start(JobSpec(), std::make_unique<Counted>(sink.solved), executor, sink);
  for (int i = 0; i < 20; ++i) job->Add({RingLayer(5, i), Point{}, {}});
  job->Close();
  executor.Run();

  ASSERT_TRUE(sink.done);
  for (const auto& [index, solved] : sink.solved_at)
    EXPECT_EQ(solved, static_cast<int>(index) + 1) << "layer " << index;
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

// Uses all the time it is given, and counts the layers that were given any.
class Greedier : public Strategy {
 public:
  Greedier(std::atomic<int>& in_time, const TimeSource& time) : in_time_(in_time), time_(time) {}
  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const bool has_time = budget.deadline() > time_.Now();
    while (!budget.ExhaustedNow()) {
    }
    in_time_ += has_time;
    return Solution{GivenRoute(*problem.plan), StopReason::kTimeLimit, std::nullopt};
  }

 private:
  std::atomic<int>& in_time_;
  const TimeSource& time_;
};

TEST(LayerChain, NoLayerTakesTheTimeOfThoseAfterIt) {
  std::atomic<int> in_time{0};
  const StepClock clock;
  RecordingSink sink;
  TestExecutor executor(1);  // time passes by what one thread reads
  std::promise<void> added;
  executor.Submit([&added] { added.get_future().wait(); });
  JobSpec spec;
  spec.deadline = StepClock::At(500'000);
  spec.time = &clock;
  auto job = Job::Start(spec, std::make_unique<Greedier>(in_time, clock), executor, sink);
  for (int i = 0; i < 10; ++i) job->Add({RingLayer(5, i), Point{}, {}});
  job->Close();
  added.set_value();
  sink.Wait();

  ASSERT_EQ(sink.outcomes.size(), 10u);
  EXPECT_EQ(in_time, 10);
}

TEST(LayerChain, AJobWithoutLayersIsDone) {
  RunOptions options;
  options.layers = 0;

  EXPECT_TRUE(RunJob(options).empty());
}

// A strategy that works until it is cancelled.
class Endless : public Strategy {
 public:
  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    while (!budget.ExhaustedNow()) std::this_thread::yield();
    return Solution{GivenRoute(*problem.plan), StopReason::kCancelled, std::nullopt};
  }
};

TEST(LayerChain, CancelEndsTheJobWithin50Milliseconds) {
  RecordingSink sink;
  TestExecutor executor(2);
  auto job = Job::Start(JobSpec(), std::make_unique<Endless>(), executor, sink);
  for (int i = 0; i < 100; ++i) job->Add({RingLayer(3, i), std::nullopt, std::nullopt});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));

  const testing::ProcessorWatch watch;
  job->Cancel();
  job->Cancel();
  sink.Wait();

  EXPECT_LT(watch.Seconds(), 2 * 0.05) << "of two threads";
  EXPECT_TRUE(sink.outcomes.empty());
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
