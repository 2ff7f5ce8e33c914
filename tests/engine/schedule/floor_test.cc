// No answer costs more than greedy's, however short the time: by a clock that only the job moves.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "tests/support/problems/instances.h"
#include "tests/support/recording_sink.h"
#include "tests/support/step_clock.h"
#include "tests/support/test_executor.h"

namespace traverse {
namespace {

// Contours scattered over islands, in an order that is far from a good one.
Plan ScatteredLayer(uint64_t seed, int contours = 48) {
  Rng rng(seed);
  std::vector<IslandPaths> islands(6);
  for (int i = 0; i < contours; ++i) {
    const Point c{200 * rng.Unit(), 200 * rng.Unit()};
    islands[static_cast<size_t>(i) % islands.size()].contours.push_back(
        MakeContour({{c.x, c.y}, {c.x + 2, c.y}, {c.x + 2, c.y + 2}, {c.x, c.y + 2}}));
  }
  return SequentialPlan(islands);
}

// More points than greedy may do late.
constexpr int kLarge = 21'000;

struct Case {
  std::string strategy;
  int layers = 5;
  int contours = 48;      // of each layer
  bool announced = true;  // as a batch is; otherwise as a stream whose caller sends on
  bool look_ahead = false;
  int64_t deadline = 0;                                        // in readings of the clock; 0: none
  std::optional<Budget::Clock::time_point> at = std::nullopt;  // instead of that
  int large = -1;                                              // the layer that has kLarge contours
  int64_t pause = 0;  // readings between the answer to a layer and the next layer
  int64_t stop_at = -1;
  int64_t stop = 0;
};

std::string NameOf(const Case& of) {
  return of.strategy + (of.announced ? " batch" : " stream") + (of.look_ahead ? " ahead" : "") +
         " by " + std::to_string(of.deadline) + " stopped at " + std::to_string(of.stop_at);
}

struct Run {
  std::vector<LayerOutcome> outcomes;
  int64_t readings = 0;
};

Run RunCase(const Case& of) {
  const StepClock clock(of.stop_at, of.stop);
  RecordingSink sink;
  TestExecutor executor(1);
  JobSpec spec;
  spec.time = &clock;
  if (of.deadline > 0) spec.deadline = StepClock::At(of.deadline);
  if (of.at) spec.deadline = of.at;
  auto job = Job::Start(spec, *MakeStrategy(of.strategy, {}), executor, sink);
  std::vector<Plan> plans;
  for (int i = 0; i < of.layers; ++i) {
    plans.push_back(i == of.large ? ScatteredLayer(1, kLarge)
                                  : ScatteredLayer(static_cast<uint64_t>(i) + 1, of.contours));
  }
  if (of.announced) {
    for (const Plan& plan : plans) job->Announce(plan);
    job->AnnounceEnd();
  }
  for (int i = 0; i < of.layers; ++i) {
    JobLayer layer;
    layer.plan = plans[static_cast<size_t>(i)];
    layer.more_follows = of.look_ahead && i + 1 < of.layers;
    job->Add(std::move(layer));
    if (of.pause > 0 && sink.WaitForAnswers(static_cast<size_t>(i) + 1)) clock.Pass(of.pause);
  }
  job->Close();
  sink.Wait();
  return {std::move(sink.outcomes), clock.readings()};
}

double GreedyCost(const LayerOutcome& outcome) {
  const LayerProblem problem{&outcome.plan, outcome.start, std::nullopt, CostSpec(), 1};
  Budget budget;
  return RouteCost(problem, (*MakeStrategy("greedy", {}))->Solve(problem, budget).route);
}

double GreedyChainCost(int layers, int contours) {
  Case greedy{.strategy = "greedy", .layers = layers, .contours = contours};
  double cost = 0;
  for (const LayerOutcome& outcome : RunCase(greedy).outcomes) cost += outcome.cost;
  return cost;
}

void ExpectWithinGreedy(const Case& of) {
  SCOPED_TRACE(NameOf(of));
  const Run run = RunCase(of);
  ASSERT_EQ(run.outcomes.size(), static_cast<size_t>(of.layers));
  double sum = 0;
  double greedy = 0;
  for (const LayerOutcome& outcome : run.outcomes) {
    sum += outcome.cost;
    greedy += GreedyCost(outcome);
    if (of.look_ahead || outcome.index == static_cast<uint64_t>(of.large)) continue;
    EXPECT_LE(outcome.cost, GreedyCost(outcome) + 1e-6) << outcome.index;
  }
  if (of.large >= 0) return;
  // A job that looks ahead may begin layers where greedy would go on from well.
  if (!of.look_ahead) {
    EXPECT_LE(sum, greedy + 1e-6);
  }
  EXPECT_LE(sum, GreedyChainCost(of.layers, of.contours) * (1 + 1e-6));
}

// What greedy takes for all layers.
int64_t GreedyReadings(int layers, int contours = 48) {
  Case greedy{.strategy = "greedy", .layers = layers, .contours = contours};
  greedy.deadline = int64_t{1} << 40;
  return RunCase(greedy).readings;
}

std::vector<std::string> AllButNone() {
  std::vector<std::string> names;
  for (const StrategyEntry& entry : Strategies()) {
    if (entry.name != "none") names.push_back(entry.name);
  }
  return names;
}

TEST(Floor, HoldsForEveryStrategyHoweverShortTheTime) {
  const int64_t least = GreedyReadings(5);
  for (const std::string& strategy : AllButNone()) {
    for (const int64_t times : {3, 4, 7, 15, 40}) {
      for (const int variant : {0, 1, 2, 3}) {
        Case of{.strategy = strategy};
        of.announced = variant % 2 == 0;
        of.look_ahead = variant >= 2;
        of.deadline = times * least;
        ExpectWithinGreedy(of);
      }
    }
  }
}

TEST(Floor, HoldsForManyLayers) {
  const int64_t least = GreedyReadings(60);
  for (const std::string& strategy : AllButNone()) {
    for (const bool announced : {false, true}) {
      Case of{.strategy = strategy, .layers = 60, .announced = announced};
      of.deadline = 4 * least;
      ExpectWithinGreedy(of);
    }
  }
}

// The first layers' searches end by themselves, for the sake of those behind, which the clock then
// cuts short.
TEST(Floor, HoldsWhereSomeLayersAreSearchedToTheEnd) {
  for (const int contours : {3, 6, 12}) {
    const int64_t least = GreedyReadings(10, contours);
    for (int64_t deadline = 4 * least; deadline < 1000 * least; deadline += deadline / 3) {
      Case of{.strategy = "auto", .layers = 10, .contours = contours, .look_ahead = true};
      of.deadline = deadline;
      ExpectWithinGreedy(of);
    }
  }
}

// As if the machine had been stopped amid the job.
TEST(Floor, HoldsWhereTimePassesAtOnce) {
  const int64_t least = GreedyReadings(5);
  for (const std::string& strategy : AllButNone()) {
    for (const int64_t at : {1, 3, 5, 8, 12}) {
      Case of{.strategy = strategy, .look_ahead = at % 2 == 0};
      of.deadline = 20 * least;
      of.stop_at = at * least;
      of.stop = 5 * least;
      ExpectWithinGreedy(of);
    }
  }
}

// Finds the shortest route, and says that time was up.
class CutShort : public Strategy {
 public:
  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    Solution solution = (*MakeStrategy("auto", {}))->Solve(problem, budget);
    solution.stop = StopReason::kTimeLimit;
    return solution;
  }
};

Plan PointsAnywhere(Rng& rng, int count) {
  IslandPaths island;
  for (int i = 0; i < count; ++i)
    island.contours.push_back(MakeContour({{100 * rng.Unit(), 100 * rng.Unit()}}));
  return SequentialPlan({island});
}

// How two layers come.
struct TwoLayers {
  bool one_by_one = false;  // the second one after the answer to the first
  bool walls = false;       // across the layer; what counts is time
};

JobLayer LayerOf(Plan plan, const TwoLayers& of) {
  JobLayer layer;
  layer.plan = std::move(plan);
  if (!of.walls) return layer;
  layer.cost = CostSpec{.kind = CostSpec::Kind::kTime,
                        .speed_mm_s = 100,
                        .accel_mm_s2 = 1000,
                        .retraction_seconds = 0.3,
                        .retraction_threshold_mm = 20};
  layer.cost->crossing_seconds = 0.2;
  for (const double x : {30.0, 60.0}) layer.walls.walls.push_back({{{x, -10}, {x, 110}}, false});
  return layer;
}

double CostOfTwoLayers(std::unique_ptr<Strategy> strategy, uint64_t seed, const TwoLayers& of) {
  const StepClock clock;
  RecordingSink sink;
  TestExecutor executor(1);
  JobSpec spec;
  spec.time = &clock;
  spec.deadline = StepClock::At(int64_t{1} << 40);
  std::promise<void> added;
  executor.Submit([all = added.get_future().share()] { all.wait(); });
  auto job = Job::Start(spec, std::move(strategy), executor, sink);
  Rng rng(seed);
  job->Add(LayerOf(PointsAnywhere(rng, 5), of));
  if (of.one_by_one) {
    added.set_value();
    EXPECT_TRUE(sink.WaitForAnswers(1));
  }
  job->Add(LayerOf(PointsAnywhere(rng, 1), of));
  job->Close();
  if (!of.one_by_one) added.set_value();
  sink.Wait();
  double cost = 0;
  for (const LayerOutcome& outcome : sink.outcomes) cost += outcome.cost;
  return cost;
}

// The next layer may be far from the end of the shortest route, and near that of greedy's.
TEST(Floor, HoldsForAJobWhoseCheapestRoutesEndFarFromTheNextLayer) {
  for (const TwoLayers of :
       {TwoLayers(), TwoLayers{true, false}, TwoLayers{false, true}, TwoLayers{true, true}}) {
    for (uint64_t seed = 1; seed <= 100; ++seed) {
      const double greedy = CostOfTwoLayers(*MakeStrategy("greedy", {}), seed, of);
      EXPECT_LE(CostOfTwoLayers(std::make_unique<CutShort>(), seed, of), greedy + 1e-6)
          << seed << " one by one " << of.one_by_one << " walls " << of.walls;
    }
  }
}

TEST(Floor, HoldsWhereThereNeverWasAnyTime) {
  for (const std::string& strategy : AllButNone()) {
    for (const auto at : {StepClock::At(-5'000'000), StepClock::At(0),
                          StepClock::At(0) + std::chrono::nanoseconds(1)}) {
      for (const bool announced : {false, true}) {
        Case of{.strategy = strategy, .announced = announced};
        of.at = at;
        ExpectWithinGreedy(of);
      }
    }
  }
}

// A layer a second, and two seconds for all.
TEST(Floor, HoldsForAStreamThatSendsOnAfterItsDeadline) {
  const int64_t second = 10 * GreedyReadings(5);
  for (const std::string& strategy : AllButNone()) {
    Case of{.strategy = strategy, .announced = false};
    of.deadline = 2 * second;
    of.pause = second;
    ExpectWithinGreedy(of);
  }
}

// For which even greedy has no time.
TEST(Floor, HoldsForTheSmallLayersBesideAHugeOne) {
  const int64_t least = GreedyReadings(30);
  for (const std::string& strategy : AllButNone()) {
    for (const int large : {0, 15}) {
      Case of{.strategy = strategy, .layers = 30};
      of.large = large;
      of.deadline = 4 * least;
      ExpectWithinGreedy(of);
    }
  }
}

}  // namespace
}  // namespace traverse
