#include "engine/schedule/layer_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "tests/engine/schedule/ring_job.h"
#include "tests/support/problems/instances.h"
#include "tests/support/recording_sink.h"
#include "tests/support/step_clock.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// What a strategy is asked for, by several threads.
struct Calls {
  std::atomic<int> prepared = 0;
  std::atomic<int> dropped = 0;
  std::atomic<int> solved = 0;
  std::atomic<int> resumed_after_solve = 0;
  std::atomic<int> resumed_without_solve = 0;
};

// Answers with the route it is given, or the order given backwards: a layer whose route no other
// takes the place of does not end where it is predicted to.
class NotingLayer : public PreparedLayer {
 public:
  explicit NotingLayer(Calls& calls) : calls_(calls) { ++calls_.prepared; }
  ~NotingLayer() override { ++calls_.dropped; }

  Solution Solve(const LayerProblem& problem, Budget&) override {
    ++calls_.solved;
    solved_ = true;
    Route route = GivenRoute(*problem.plan);
    return Solution{Route(route.rbegin(), route.rend()), StopReason::kLocalOptimum, std::nullopt};
  }
  Solution Resume(const LayerProblem&, const Route& start, Budget&) override {
    ++(solved_ ? calls_.resumed_after_solve : calls_.resumed_without_solve);
    return Solution{start, StopReason::kLocalOptimum, std::nullopt};
  }
  Solution ResumeWithNext(const LayerProblem& problem, const Route& start, std::vector<NextLayer>&,
                          Budget& budget) override {
    return Resume(problem, start, budget);
  }

 private:
  Calls& calls_;
  bool solved_ = false;
};

class Noting : public PreparingStrategy {
 public:
  Noting(Calls& calls, const StrategyTraits& traits) : PreparingStrategy(traits), calls_(calls) {}
  std::unique_ptr<PreparedLayer> Prepare(const Plan&) const override {
    return std::make_unique<NotingLayer>(calls_);
  }

 private:
  Calls& calls_;
};

// Runs a job of layers that are rows of dots, none like another.
void RunRows(Calls& calls, int layers, const StrategyTraits& traits) {
  RecordingSink sink;
  TestExecutor executor(4);
  auto job = Job::Start(JobSpec(), std::make_unique<Noting>(calls, traits), executor, sink);
  for (int i = 0; i < layers; ++i) {
    std::vector<Path> dots;
    for (int k = 0; k < 5; ++k) dots.push_back(MakeContour({{10.0 * k + i, 5.0 + i * k}}));
    JobLayer layer{AnyOrderPlan(std::move(dots)), std::nullopt, std::nullopt};
    layer.more_follows = i + 1 < layers;
    job->Add(std::move(layer));
  }
  job->Close();
  sink.Wait();
  EXPECT_EQ(sink.outcomes.size(), static_cast<size_t>(layers));
  // What is derived of a plan is large: it goes with the layer, not with the job.
  EXPECT_EQ(calls.dropped, calls.prepared);
}

TEST(LayerSolver, ALayerIsPreparedOnceForAllItsStages) {
  Calls calls;
  RunRows(calls, 20, {.pure = true});

  EXPECT_EQ(calls.prepared, 20);
  EXPECT_EQ(calls.solved, 20);
  EXPECT_GT(calls.resumed_after_solve, 5);
  EXPECT_EQ(calls.resumed_without_solve, 0);
}

TEST(LayerSolver, ALayerSeenFromTheOneBeforeIsNotPreparedAgain) {
  Calls calls;
  RunRows(calls, 40, {.look_ahead_paths = 100});

  EXPECT_EQ(calls.prepared, 40);
  EXPECT_GT(calls.resumed_after_solve, 20);
  EXPECT_EQ(calls.resumed_without_solve, 0);
}

TEST(LayerSolver, SerialStrategiesPrepareEachLayerOnce) {
  Calls calls;
  RunRows(calls, 20, {.serial = true});

  EXPECT_EQ(calls.prepared, 20);
  EXPECT_EQ(calls.solved, 20);
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

TEST(LayerSolver, ReplacesAnInvalidRouteByTheGivenOrder) {
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

TEST(LayerSolver, IsNeverWorseThanGreedyFromTheTrueStart) {
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

// Takes all the time that it is given, and notes how much that is.
class SpendingLayer : public PreparedLayer {
 public:
  SpendingLayer(std::atomic<double>& given, const TimeSource& time) : given_(given), time_(time) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) override {
    return Resume(problem, GivenRoute(*problem.plan), budget);
  }
  Solution Resume(const LayerProblem&, const Route& start, Budget& budget) override {
    const std::chrono::duration<double> given = *budget.deadline() - time_.Now();
    given_ = given_ + given.count();
    while (!budget.ExhaustedNow()) {
    }
    return Solution{start, StopReason::kTimeLimit, std::nullopt};
  }
  Solution ResumeWithNext(const LayerProblem& problem, const Route& start, std::vector<NextLayer>&,
                          Budget& budget) override {
    return Resume(problem, start, budget);
  }

 private:
  std::atomic<double>& given_;
  const TimeSource& time_;
};

class Spending : public PreparingStrategy {
 public:
  Spending(std::atomic<double>& given, const TimeSource& time, const StrategyTraits& traits)
      : PreparingStrategy(traits), given_(given), time_(time) {}
  std::unique_ptr<PreparedLayer> Prepare(const Plan&) const override {
    return std::make_unique<SpendingLayer>(given_, time_);
  }

 private:
  std::atomic<double>& given_;
  const TimeSource& time_;
};

// Of a layer.
constexpr double kLimitSeconds = 0.2;

// In seconds, all that is given to a job of layers that differ.
double GivenTo(int layers, bool more_follows) {
  std::atomic<double> given = 0;
  const StepClock clock;
  RecordingSink sink;
  TestExecutor executor(1);
  JobSpec spec;
  spec.layer_time_limit = absl::Seconds(kLimitSeconds);
  spec.time = &clock;
  auto job = Job::Start(
      spec, std::make_unique<Spending>(given, clock, StrategyTraits{.look_ahead_paths = 100}),
      executor, sink);
  for (int i = 1; i <= layers; ++i) {
    std::vector<Path> dots;
    for (int k = 0; k < 5; ++k) dots.push_back(MakeContour({{10.0 * k * i, 5.0 + i}}));
    JobLayer layer{AnyOrderPlan(std::move(dots)), std::nullopt, std::nullopt};
    layer.more_follows = more_follows || i < layers;
    job->Add(std::move(layer));
  }
  job->Close();
  sink.Wait();
  return given;
}

TEST(LayerSolver, AllStagesOfALayerTogetherHaveItsTimeLimit) {
  for (const bool more_follows : {false, true}) {
    const double one = GivenTo(1, more_follows);
    EXPECT_GT(one, 0.875 * kLimitSeconds) << more_follows;
    EXPECT_LT(one, 1.0025 * kLimitSeconds) << more_follows;
    const double three = GivenTo(3, more_follows);
    EXPECT_GT(three, 3 * 0.75 * kLimitSeconds) << more_follows;
    EXPECT_LT(three, 3 * 1.0025 * kLimitSeconds) << more_follows;
  }
}

}  // namespace
}  // namespace traverse
