#include "engine/strategy/exact.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/cost/route_cost.h"
#include "engine/exact/stage_model.h"
#include "engine/exact/stage_proof.h"
#include "engine/strategy/ni2opt.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

// Numbers in a model's matrices: 16 bytes each.
constexpr size_t kMostModelEntries = size_t{16} << 20;

std::unique_ptr<Strategy> MakeDefault(const StrategyEntry& entry) {
  return entry.make(*StrategyOptions::Parse(entry.options, {}));
}

class Exact : public Strategy {
 public:
  explicit Exact(double time_limit_seconds)
      : time_limit_seconds_(time_limit_seconds), heuristic_(MakeDefault(Ni2optEntry())) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    return Prove(problem, heuristic_->Solve(problem, budget).route, budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    Route route = heuristic_->Solve(problem, budget).route;
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
    if (!model || !CanProveByStages(*model)) return solution;
    const StageProof result =
        ProveByStages(*model, model->WalkOf(solution.route), StageProofOptions(), limited);
    Route route = model->RouteOf(result.walk);
    if (RouteCost(problem, route) <= RouteCost(problem, solution.route)) {
      solution.route = std::move(route);
    }
    solution.lower_bound = result.lower_bound;
    solution.stop = result.proven ? StopReason::kOptimal : StopOr(limited, solution.stop);
    return solution;
  }

  const double time_limit_seconds_;
  const std::unique_ptr<Strategy> heuristic_;  // of the first route
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
