#include "engine/schedule/layer_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "tests/engine/schedule/ring_job.h"
#include "tests/support/instances.h"
#include "tests/support/recording_sink.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

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

}  // namespace
}  // namespace traverse
