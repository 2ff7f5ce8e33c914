#include "engine/strategy/greedy.h"

#include <memory>
#include <optional>
#include <utility>

#include "engine/construct/greedy.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

class Greedy : public Strategy {
 public:
  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    Route route = BaselineRoute(LayerView(problem), budget);
    return Solution{std::move(route), StopOr(budget, StopReason::kLocalOptimum), std::nullopt};
  }
  bool serial() const override { return true; }
};

}  // namespace

StrategyEntry GreedyEntry() {
  return StrategyEntry{"greedy",
                       "Always the nearest point at which a path may be begun; the order given "
                       "where that is no longer.",
                       false,
                       {},
                       [](const StrategyOptions&) -> std::unique_ptr<Strategy> {
                         return std::make_unique<Greedy>();
                       }};
}

}  // namespace traverse
