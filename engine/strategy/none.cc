#include "engine/strategy/none.h"

#include <memory>

namespace traverse {
namespace {

class None : public Strategy {
 public:
  Solution Solve(const LayerProblem& problem, Budget&) const override {
    return Solution{GivenRoute(*problem.plan), StopReason::kLocalOptimum, std::nullopt};
  }
  bool serial() const override { return true; }
};

}  // namespace

StrategyEntry NoneEntry() {
  return StrategyEntry{
      "none",
      "The order and the entries as given: the baseline of every report.",
      false,
      {},
      [](const StrategyOptions&) -> std::unique_ptr<Strategy> { return std::make_unique<None>(); }};
}

}  // namespace traverse
