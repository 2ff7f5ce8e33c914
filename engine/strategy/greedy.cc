#include "engine/strategy/greedy.h"

#include <memory>
#include <optional>
#include <utility>

#include "engine/search/greedy/greedy.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

class Greedy : public Strategy {
 public:
  explicit Greedy(bool pure) : Strategy({.serial = true, .pure = pure, .searches = false}) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const LayerView layer(problem, &budget);
    Route route = traits().pure ? GreedyRoute(layer, budget) : BaselineRoute(layer, budget);
    return Solution{std::move(route), StopOr(budget, StopReason::kLocalOptimum), std::nullopt};
  }
};

}  // namespace

StrategyEntry GreedyEntry() {
  return StrategyEntry{
      "greedy",
      "Goes to the nearest point at which a path may be entered; returns the given order if that "
      "is no longer.",
      false,
      {PureOption(
          "Metodo 1 as published: never replaces its route by a shorter one of another method.")},
      [](const StrategyOptions& options) -> std::unique_ptr<Strategy> {
        return std::make_unique<Greedy>(options.Bool("pure"));
      }};
}

}  // namespace traverse
