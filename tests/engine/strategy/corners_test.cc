// What every strategy promises at the ends of what the API lets in: of each figure of the cost, of
// the coordinates and of each option, one at a time and together.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"
#include "tests/support/step_clock.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// Rounding of a sum of costs, relative to it.
constexpr double kRounding = 1e-9;

// A search that goes round in circles ends after so many looks at the clock; one that is merely
// long does so as well.
constexpr int64_t kLooks = 2000;

// The range of the API: server/translate/field_ranges.cc.
std::vector<CostSpec> CornerCosts() {
  std::vector<CostSpec> costs = {CostSpec()};
  for (const double speed : {1e-3, 20.0, 1e5}) {
    for (const double accel : {0.0, 1e-3, 1e7}) {
      for (const double retraction : {0.0, 1e4}) {
        for (const double threshold : {0.0, 1e7}) {
          costs.push_back({CostSpec::Kind::kTime, speed, accel, retraction, threshold});
        }
      }
    }
  }
  return costs;
}

// Where the points of a plan are: at (x * factor + shift, y * factor + shift).
struct Placement {
  double factor;
  double shift;
};
constexpr Placement kPlacements[] = {{1, 0},      {1e4, 0},  {2e4, -1e6}, {1e-6, 0},
                                     {1e-6, 1e6}, {1e-9, 0}, {1, 999900}, {0, 1e6}};

OwnedProblem Placed(const OwnedProblem& owned, const Placement& placement) {
  const auto within = [&](double coordinate) {
    return std::clamp(coordinate * placement.factor + placement.shift, -kMaxCoordinateMm,
                      kMaxCoordinateMm);
  };
  const auto place = [&](Point p) { return Point{within(p.x), within(p.y)}; };
  Plan plan = owned.plan();
  for (Path& path : plan.paths) {
    for (Point& point : path.points) point = place(point);
  }
  OwnedProblem placed(std::move(plan), place(owned.problem.start));
  placed.problem.cost = owned.problem.cost;
  placed.problem.seed = owned.problem.seed;
  if (owned.problem.finish) placed.problem.finish = place(*owned.problem.finish);
  return placed;
}

class CornersOf : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    ASSERT_OK_AND_ASSIGN(strategy_, MakeStrategy(GetParam(), {}));
    ASSERT_OK_AND_ASSIGN(greedy_, MakeStrategy("greedy", {}));
  }

  // That the solution is valid, no worse than greedy, and its bound true.
  void Check(const OwnedProblem& owned, std::optional<double> optimum) {
    const StepClock clock;
    Budget budget(nullptr, StepClock::At(kLooks), nullptr, &clock);
    const Solution solution = strategy_->Solve(owned.problem, budget);

    ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
    const double cost = RouteCost(owned.problem, solution.route);
    ASSERT_TRUE(std::isfinite(cost));
    const double given = RouteCost(owned.problem, GivenRoute(owned.plan()));
    EXPECT_LE(cost, given * (1 + kRounding));
    if (GetParam() != "none" && solution.stop != StopReason::kTimeLimit) {
      Budget unlimited;
      const Route greedy = greedy_->Solve(owned.problem, unlimited).route;
      EXPECT_LE(cost, RouteCost(owned.problem, greedy) * (1 + kRounding));
    }
    if (solution.lower_bound) {
      EXPECT_LE(*solution.lower_bound, cost * (1 + kRounding));
    }
    if (!optimum) return;
    EXPECT_GE(cost, *optimum * (1 - kRounding));
    if (solution.lower_bound) {
      EXPECT_LE(*solution.lower_bound, *optimum * (1 + kRounding));
    }
  }

  std::unique_ptr<Strategy> strategy_;
  std::unique_ptr<Strategy> greedy_;
};

TEST_P(CornersOf, TheCostAreAsGoodAsTheMiddle) {
  uint64_t seed = 0;
  for (const CostSpec& cost : CornerCosts()) {
    for (const Placement& placement : kPlacements) {
      ++seed;
      SCOPED_TRACE(absl::StrCat("seed ", seed, ", speed ", cost.speed_mm_s, ", acceleration ",
                                cost.accel_mm_s2, ", retraction ", cost.retraction_seconds,
                                " beyond ", cost.retraction_threshold_mm, ", points times ",
                                placement.factor, " plus ", placement.shift));
      OwnedProblem small = Placed(RandomProblem(seed, {.max_paths = 6}), placement);
      small.problem.cost = cost;
      Check(small, BruteForce(small.problem).cost);
      if (seed % 5 != 0) continue;
      OwnedProblem large =
          Placed(RandomProblem(seed, {.min_paths = 30, .max_paths = 80}), placement);
      large.problem.cost = cost;
      Check(large, std::nullopt);
    }
  }
}

// Small problems are solved as well as anywhere: the optimum, without a limit of time.
TEST_P(CornersOf, TheCostDoNotHideTheOptimum) {
  if (GetParam() != "auto" && GetParam() != "exact") GTEST_SKIP() << "promises no optimum";
  uint64_t seed = 0;
  for (const CostSpec& cost : CornerCosts()) {
    for (const Placement& placement : kPlacements) {
      ++seed;
      SCOPED_TRACE(absl::StrCat("seed ", seed));
      OwnedProblem owned = Placed(RandomProblem(seed, {.max_paths = 6}), placement);
      owned.problem.cost = cost;
      Budget budget;

      const Solution solution = strategy_->Solve(owned.problem, budget);

      const double optimum = BruteForce(owned.problem).cost;
      EXPECT_LE(RouteCost(owned.problem, solution.route), optimum * (1 + kRounding));
      EXPECT_EQ(solution.stop, StopReason::kOptimal);
    }
  }
}

// The values of an option that are worth trying, as text.
std::vector<std::string> CornersOfOption(const OptionSpec& spec) {
  switch (spec.type) {
    case OptionSpec::Type::kBool:
      return {"true", "false"};
    case OptionSpec::Type::kChoice:
      return spec.values;
    case OptionSpec::Type::kInt:
      return {absl::StrCat(static_cast<int64_t>(spec.minimum)),
              absl::StrCat(static_cast<int64_t>(spec.maximum))};
    case OptionSpec::Type::kDouble:
      return {absl::StrCat(spec.minimum), absl::StrCat(spec.maximum)};
  }
  return {};
}

TEST_P(CornersOf, TheOptionsGiveValidRoutes) {
  for (const StrategyEntry& entry : Strategies()) {
    if (entry.name != GetParam()) continue;
    for (const OptionSpec& spec : entry.options) {
      for (const std::string& value : CornersOfOption(spec)) {
        SCOPED_TRACE(absl::StrCat(spec.name, "=", value));
        ASSERT_OK_AND_ASSIGN(strategy_, MakeStrategy(entry.name, {{spec.name, value}}));
        for (uint64_t seed = 1; seed <= 6; ++seed) {
          SCOPED_TRACE(absl::StrCat("seed ", seed));
          const StepClock clock;
          Budget budget(nullptr, StepClock::At(kLooks), nullptr, &clock);
          const OwnedProblem owned =
              RandomProblem(seed, {.min_paths = 1, .max_paths = seed % 2 == 0 ? 60 : 6});

          const Solution solution = strategy_->Solve(owned.problem, budget);

          ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
        }
      }
    }
  }
}

// Several options at their ends at once, in every place of the coordinates.
TEST_P(CornersOf, TheOptionsTogetherGiveValidRoutes) {
  for (const StrategyEntry& entry : Strategies()) {
    if (entry.name != GetParam() || entry.options.empty()) continue;
    const std::vector<CostSpec> costs = CornerCosts();
    for (uint64_t seed = 1; seed <= 60; ++seed) {
      Rng rng(seed);
      std::map<std::string, std::string> values;
      std::string text;
      for (const OptionSpec& spec : entry.options) {
        const std::vector<std::string> corners = CornersOfOption(spec);
        const uint32_t chosen = rng.Below(static_cast<uint32_t>(corners.size()) + 1);
        if (chosen == corners.size()) continue;
        values[spec.name] = corners[chosen];
        absl::StrAppend(&text, " ", spec.name, "=", corners[chosen]);
      }
      SCOPED_TRACE(absl::StrCat("seed ", seed, ",", text));
      ASSERT_OK_AND_ASSIGN(strategy_, MakeStrategy(entry.name, values));
      const Placement& placement = kPlacements[rng.Below(std::size(kPlacements))];
      OwnedProblem owned = Placed(RandomProblem(seed, {.max_paths = 40}), placement);
      owned.problem.cost = costs[rng.Below(static_cast<uint32_t>(costs.size()))];
      const StepClock clock;
      Budget budget(nullptr, StepClock::At(kLooks), nullptr, &clock);

      const Solution solution = strategy_->Solve(owned.problem, budget);

      ASSERT_OK(ValidateRoute(owned.plan(), solution.route));
    }
  }
}

std::vector<std::string> Names() {
  std::vector<std::string> names;
  for (const StrategyEntry& entry : Strategies()) names.push_back(entry.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, CornersOf, ::testing::ValuesIn(Names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace traverse
