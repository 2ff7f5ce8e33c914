#include "engine/strategy/none.h"

#include <memory>

namespace traverse {
namespace {

class None : public Strategy {
 public:
  None() : Strategy({.serial = true, .pure = true, .searches = false}) {}

  Solution Solve(const LayerProblem& problem, Budget&) const override {
    return Solution{GivenRoute(*problem.plan), StopReason::kLocalOptimum, std::nullopt};
  }

  // A route that the caller knows is the one to keep, also if the given order costs less.
  Solution Resume(const LayerProblem&, const Route& start, Budget&) const override {
    return Solution{start, StopReason::kLocalOptimum, std::nullopt};
  }
};

}  // namespace

StrategyEntry NoneEntry() {
  return StrategyEntry{
      "none",
      "Keeps the given order and entries, or a layer's initial_route: the baseline of every "
      "report.",
      false,
      {},
      [](const StrategyOptions&) -> std::unique_ptr<Strategy> { return std::make_unique<None>(); }};
}

}  // namespace traverse
