#include "engine/strategy/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/processor_watch.h"
#include "tests/support/sanitizers.h"
#include "tests/support/status_matchers.h"
#include "tests/support/step_clock.h"

namespace traverse {
namespace {

using testing::OwnedProblem;
using testing::RandomProblem;

std::unique_ptr<Strategy> MakeExact() { return *MakeStrategy("exact", {}); }

std::unique_ptr<Strategy> MakeFramework(std::map<std::string, std::string> options) {
  options["model"] = "framework";
  return *MakeStrategy("exact", options);
}

TEST(Exact, IsOptimalWhereItSaysSo) {
  const std::unique_ptr<Strategy> exact = MakeExact();
  int proven = 0;
  for (uint64_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed);
    const double best = testing::BruteForce(owned.problem).cost;
    Budget budget;

    const Solution solution = exact->Solve(owned.problem, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
    const double cost = RouteCost(owned.problem, solution.route);
    if (solution.stop == StopReason::kOptimal) {
      ++proven;
      EXPECT_NEAR(cost, best, 1e-6 * (1 + best));
      ASSERT_TRUE(solution.lower_bound.has_value());
      EXPECT_NEAR(*solution.lower_bound, cost, 1e-6 * (1 + best));
    }
    EXPECT_LE(solution.lower_bound.value_or(0), best + 1e-6 * (1 + best));
  }
  EXPECT_EQ(proven, 150);
}

TEST(Exact, BothModelsBearDegenerateGeometry) {
  const std::unique_ptr<Strategy> exact = MakeExact();
  const std::unique_ptr<Strategy> framework = MakeFramework({{"time_limit", "0.05"}});
  for (const testing::Degeneracy degeneracy : testing::kDegeneracies) {
    for (uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(absl::StrCat("degeneracy ", static_cast<int>(degeneracy), ", seed ", seed));
      const OwnedProblem owned =
          testing::Degenerate(RandomProblem(seed, {.max_paths = 6, .max_vertices = 4}), degeneracy);
      const double best = testing::BruteForce(owned.problem).cost;
      Budget budget;

      const Solution proven = exact->Solve(owned.problem, budget);
      const Solution found = framework->Solve(owned.problem, budget);

      EXPECT_EQ(proven.stop, StopReason::kOptimal);
      EXPECT_NEAR(RouteCost(owned.problem, proven.route), best, 1e-6 * (1 + best));
      ASSERT_OK(ValidateRoute(owned.plan(), found.route));
      EXPECT_GE(RouteCost(owned.problem, found.route), best - 1e-6 * (1 + best));
    }
  }
}

// How much longer everything takes where a sanitizer looks on.
constexpr int kSlower = testing::kSanitized ? 10 : 1;

// What the exact search has of `problem` after `milliseconds` of work, or more of them where a
// sanitizer looks on.
Solution SolutionWithin(const LayerProblem& problem, int milliseconds) {
  const ThreadClock clock;
  const auto time = std::chrono::milliseconds(milliseconds * kSlower);
  Budget budget(nullptr, clock.Now() + time, nullptr, &clock);
  return MakeExact()->Solve(problem, budget);
}

TEST(Exact, GivesABoundWhenTimeRunsOut) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(testing::kSanitized ? 20 : 12, 12)));

  const testing::ProcessorWatch watch;
  const Solution solution = SolutionWithin(owned.problem, 200);

  EXPECT_LT(watch.Seconds(), 20);
  ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
  EXPECT_EQ(solution.stop, StopReason::kTimeLimit);
  ASSERT_TRUE(solution.lower_bound.has_value());
  EXPECT_LE(*solution.lower_bound, RouteCost(owned.problem, solution.route));
}

// A first route far from the best leaves too many moves to branch on: that must not take longer
// than the deadline, and walks bound the layer all the same.
TEST(Exact, KeepsADeadlineFarFromAProof) {
  const OwnedProblem owned = RandomProblem(
      1, {.shape = testing::PlanShape::kSequential, .min_paths = 300, .max_paths = 300});

  const testing::ProcessorWatch watch;
  const Solution solution = SolutionWithin(owned.problem, 1000);

  EXPECT_LT(watch.Seconds(), 8.0 * kSlower);
  EXPECT_OK(ValidateRoute(owned.plan(), solution.route));
}

// Where there is no proof, for the size of the plan, there is a bound all the same.
TEST(Exact, BoundsWhatItCannotProve) {
  const OwnedProblem islands(InterleavedPlan(testing::SquareGrid(20, 13)));
  Budget budget;

  const Solution solution = MakeExact()->Solve(islands.problem, budget);

  ASSERT_TRUE(solution.lower_bound.has_value());
  EXPECT_GT(*solution.lower_bound, 0.5 * RouteCost(islands.problem, solution.route));
  EXPECT_LE(*solution.lower_bound, RouteCost(islands.problem, solution.route));
  EXPECT_EQ(solution.statistics.at("provable"), 0);
  EXPECT_EQ(solution.stop, StopReason::kLocalOptimum);
}

// Islands done one after the other, beyond what subsets can do.
TEST(Exact, ProvesInterleavedLayers) {
  const OwnedProblem islands(InterleavedPlan(testing::SquareGrid(5, 4)));
  Budget budget;

  const Solution solution = MakeExact()->Solve(islands.problem, budget);

  ASSERT_OK(ValidateRoute(islands.plan(), solution.route));
  EXPECT_EQ(solution.stop, StopReason::kOptimal);
  EXPECT_EQ(*solution.lower_bound, RouteCost(islands.problem, solution.route));
  EXPECT_GT(solution.statistics.at("passes"), 0);
}

// 500 islands in 400 ms of a core.
TEST(Exact, HasRouteAndBoundOfALargeLayerInNoTime) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(25, 20)));
  Budget unlimited;
  const Route greedy = (*MakeStrategy("greedy", {}))->Solve(owned.problem, unlimited).route;

  const Solution solution = SolutionWithin(owned.problem, 400);

  ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
  EXPECT_LE(RouteCost(owned.problem, solution.route), RouteCost(owned.problem, greedy));
  ASSERT_TRUE(solution.lower_bound.has_value());
  EXPECT_GT(*solution.lower_bound, 0);
}

TEST(Exact, IsCancelledSoon) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(14, 14)));
  CancelToken cancel;
  Budget budget(&cancel);
  std::optional<testing::ProcessorWatch> since_cancel;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    since_cancel.emplace();
    cancel.Cancel();
  });

  const Solution solution = MakeExact()->Solve(owned.problem, budget);
  canceller.join();

  EXPECT_LT(since_cancel->Seconds(), 0.5);
  EXPECT_EQ(solution.stop, StopReason::kCancelled);
  EXPECT_OK(ValidateRoute(owned.plan(), solution.route));
}

TEST(Exact, ResumesFromARouteItIsGiven) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed);
    const Route best = testing::BruteForce(owned.problem).route;
    CancelToken cancel;
    cancel.Cancel();
    Budget budget(&cancel);

    const Solution solution = MakeExact()->Resume(owned.problem, best, budget);

    EXPECT_LE(RouteCost(owned.problem, solution.route), RouteCost(owned.problem, best) + 1e-9);
  }
}

TEST(ExactFramework, FindsValidRoutesNeverWorseThanGreedy) {
  const std::unique_ptr<Strategy> greedy = *MakeStrategy("greedy", {});
  for (const char* representation : {"sp", "nrp", "bbcp"}) {
    const std::unique_ptr<Strategy> framework = MakeFramework({{"representation", representation}});
    for (uint64_t seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(absl::StrCat(representation, ", seed ", seed));
      const OwnedProblem owned =
          RandomProblem(seed, {.max_paths = 7, .max_vertices = 4, .special = seed % 2 == 0});
      Budget budget;

      const Solution solution = framework->Solve(owned.problem, budget);

      ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
      EXPECT_FALSE(solution.lower_bound.has_value());  // it would be one of the reduced points
      EXPECT_LE(RouteCost(owned.problem, solution.route),
                RouteCost(owned.problem, greedy->Solve(owned.problem, budget).route) + 1e-9);
    }
  }
}

// The gaps that the programmes are left with are told.
TEST(ExactFramework, TellsOfItsProgrammes) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(3, 2)));
  Budget budget;

  const Solution solution = MakeFramework({{"gap", "0.15"}})->Solve(owned.problem, budget);

  EXPECT_EQ(solution.stop, StopReason::kLocalOptimum);
  for (const std::string step : {"contours", "rasters"}) {
    SCOPED_TRACE(step);
    const double value = solution.statistics.at(step + "_value");
    const double bound = solution.statistics.at(step + "_bound");
    EXPECT_LE(bound, value + 1e-6);
    EXPECT_GE(bound, 0.85 * value - 1e-6);
    EXPECT_GT(solution.statistics.at(step + "_columns"), 0);
  }
}

TEST(ExactFramework, KeepsItsTimeLimit) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(5, 5)));
  Budget budget;

  const testing::ProcessorWatch watch;
  const Solution solution = MakeFramework({{"time_limit", "0.3"}})->Solve(owned.problem, budget);

  EXPECT_LT(watch.Seconds(), 5.0);
  EXPECT_EQ(solution.stop, StopReason::kTimeLimit);
  EXPECT_OK(ValidateRoute(owned.plan(), solution.route));
}

TEST(ExactFramework, IsCancelledSoon) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(5, 5)));
  CancelToken cancel;
  Budget budget(&cancel);
  std::optional<testing::ProcessorWatch> since_cancel;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    since_cancel.emplace();
    cancel.Cancel();
  });

  const Solution solution = MakeFramework({})->Solve(owned.problem, budget);
  canceller.join();

  EXPECT_LT(since_cancel->Seconds(), 1.0);
  EXPECT_EQ(solution.stop, StopReason::kCancelled);
  EXPECT_OK(ValidateRoute(owned.plan(), solution.route));
}

// What the programme did is told apart from what it was given.
TEST(ExactFramework, TellsWhatItGainedOverItsStart) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(3, 2)));
  Budget budget;

  const Solution warm = MakeFramework({})->Solve(owned.problem, budget);
  const Solution cold = MakeFramework({{"start", "none"}})->Solve(owned.problem, budget);

  for (const std::string step : {"contours", "rasters"}) {
    SCOPED_TRACE(step);
    EXPECT_NEAR(warm.statistics.at(step + "_start") - warm.statistics.at(step + "_value"),
                warm.statistics.at(step + "_gained"), 1e-9);
    EXPECT_GE(warm.statistics.at(step + "_gained"), -1e-9);
    EXPECT_EQ(cold.statistics.count(step + "_start"), 0u);
    EXPECT_EQ(cold.statistics.at(step + "_found"), 1);
    EXPECT_GE(cold.statistics.at(step + "_seconds"), 0);
    EXPECT_NEAR(cold.statistics.at(step + "_incumbent_01_value"),
                std::max(cold.statistics.at(step + "_incumbent_01_value"),
                         cold.statistics.at(step + "_value")),
                1e-6);
  }
}

// Without time a cold programme has nothing, and says so: the thesis's "NA".
TEST(ExactFramework, ColdHasNothingOfItsOwnWithoutTime) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(4, 4)));
  Budget budget;

  const Solution cold =
      MakeFramework({{"start", "none"}, {"time_limit", "0"}})->Solve(owned.problem, budget);

  EXPECT_OK(ValidateRoute(owned.plan(), cold.route));
  EXPECT_EQ(cold.statistics.at("contours_found"), 0);
  EXPECT_EQ(cold.statistics.count("contours_value"), 0u);
  EXPECT_EQ(cold.stop, StopReason::kTimeLimit);
  EXPECT_TRUE(MakeFramework({{"start", "none"}})->traits().pure);
}

TEST(ExactFramework, HasTheOptionsOfTheReductions) {
  const OwnedProblem owned(SequentialPlan(testing::PlateWithHoles()));
  Budget budget;
  const auto points = [&](const char* spacing) {
    return MakeFramework({{"spacing_mm", spacing}, {"neighbors", "3"}, {"radius_step_mm", "2"}})
        ->Solve(owned.problem, budget)
        .statistics.at("points_sp");
  };
  EXPECT_GT(points("0"), points("100"));
}

}  // namespace
}  // namespace traverse
