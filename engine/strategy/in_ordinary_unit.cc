#include "engine/strategy/in_ordinary_unit.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "engine/cost/cost_unit.h"

namespace traverse {
namespace {

LayerProblem InUnit(const LayerProblem& problem, double unit) {
  LayerProblem scaled = problem;
  scaled.cost = InUnit(problem.cost, unit);
  scaled.walls_unit *= unit;
  return scaled;
}

// See Solution::statistics.
bool IsCost(const std::string& statistic) {
  return absl::EndsWith(statistic, "_cost") || absl::EndsWith(statistic, "_value") ||
         absl::EndsWith(statistic, "_bound") || absl::EndsWith(statistic, "_start") ||
         absl::EndsWith(statistic, "_gained");
}

Solution FromUnit(Solution solution, double unit) {
  if (solution.lower_bound) *solution.lower_bound /= unit;
  for (auto& [name, value] : solution.statistics) {
    if (IsCost(name)) value /= unit;
  }
  return solution;
}

class LayerInOrdinaryUnit : public PreparedLayer {
 public:
  explicit LayerInOrdinaryUnit(std::unique_ptr<PreparedLayer> layer) : layer_(std::move(layer)) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) override {
    const double unit = CostUnit(problem.cost, {&problem});
    return FromUnit(layer_->Solve(InUnit(problem, unit), budget), unit);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) override {
    const double unit = CostUnit(problem.cost, {&problem});
    return FromUnit(layer_->Resume(InUnit(problem, unit), start, budget), unit);
  }

  Solution ResumeWithNext(const LayerProblem& problem, const Route& start,
                          std::vector<NextLayer>& next, Budget& budget) override {
    std::vector<const LayerProblem*> problems = {&problem};
    for (const NextLayer& layer : next) problems.push_back(&layer.problem);
    const double unit = CostUnit(problem.cost, problems);
    std::vector<NextLayer> scaled;
    for (NextLayer& layer : next) {
      scaled.push_back({InUnit(layer.problem, unit), std::move(layer.route)});
    }
    Solution solution = layer_->ResumeWithNext(InUnit(problem, unit), start, scaled, budget);
    for (size_t i = 0; i < next.size(); ++i) next[i].route = std::move(scaled[i].route);
    return FromUnit(std::move(solution), unit);
  }

 private:
  const std::unique_ptr<PreparedLayer> layer_;
};

class OrdinaryUnit : public PreparingStrategy {
 public:
  explicit OrdinaryUnit(std::unique_ptr<Strategy> strategy)
      : PreparingStrategy(strategy->traits()), strategy_(std::move(strategy)) {}

  std::unique_ptr<PreparedLayer> Prepare(const Plan& plan) const override {
    return std::make_unique<LayerInOrdinaryUnit>(strategy_->Prepare(plan));
  }

 private:
  const std::unique_ptr<Strategy> strategy_;
};

}  // namespace

std::unique_ptr<Strategy> InOrdinaryUnit(std::unique_ptr<Strategy> strategy) {
  return std::make_unique<OrdinaryUnit>(std::move(strategy));
}

}  // namespace traverse
