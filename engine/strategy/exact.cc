#include "engine/strategy/exact.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/construct/greedy.h"
#include "engine/cost/layer_view.h"
#include "engine/cost/route_cost.h"
#include "engine/exact/stage_model.h"
#include "engine/exact/walk_bound.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

// Numbers in a model's matrices: 16 bytes each.
constexpr size_t kMostModelEntries = size_t{16} << 20;

class Exact : public Strategy {
 public:
  explicit Exact(double time_limit_seconds) : time_limit_seconds_(time_limit_seconds) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    return Prove(problem, BaselineRoute(LayerView(problem), budget), budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    Route route = BaselineRoute(LayerView(problem), budget);
    if (RouteCost(problem, start) < RouteCost(problem, route)) route = start;
    return Prove(problem, std::move(route), budget);
  }

  // A proof holds for one start only: predicted ones would be work for nothing.
  bool trivial() const override { return true; }

 private:
  Solution Prove(const LayerProblem& problem, Route incumbent, Budget& budget) const {
    if (incumbent.empty()) {
      const double cost = RouteCost(problem, incumbent);
      return Solution{std::move(incumbent), StopReason::kOptimal, cost};
    }
    Solution solution{std::move(incumbent), StopReason::kIterationLimit, std::nullopt};
    Budget limited = budget.Within(std::chrono::duration_cast<Budget::Clock::duration>(
        std::chrono::duration<double>(time_limit_seconds_)));
    if (limited.ExhaustedNow()) {
      solution.stop = StopOr(limited, solution.stop);
      return solution;
    }
    const std::optional<StageModel> model = StageModel::Build(problem, kMostModelEntries);
    if (!model) return solution;
    WalkBoundResult result =
        BoundByWalks(*model, model->WalkOf(solution.route), WalkBoundOptions(), limited);
    Route route = model->RouteOf(result.walk);
    if (RouteCost(problem, route) <= RouteCost(problem, solution.route)) {
      solution.route = std::move(route);
    }
    solution.lower_bound = result.lower_bound;
    solution.stop = result.proven ? StopReason::kOptimal : StopOr(limited, solution.stop);
    return solution;
  }

  const double time_limit_seconds_;
};

}  // namespace

StrategyEntry ExactEntry() {
  return StrategyEntry{
      "exact",
      "Routes proven optimal; at the time limit the best one found and a lower bound.",
      true,
      {OptionSpec{"time_limit",
                  OptionSpec::Type::kDouble,
                  "7200",
                  0,
                  1e6,
                  {},
                  "Longest time for one layer, in s."}},
      [](const StrategyOptions& options) -> std::unique_ptr<Strategy> {
        return std::make_unique<Exact>(options.Double("time_limit"));
      }};
}

}  // namespace traverse
