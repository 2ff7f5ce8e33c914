#include "tests/engine/strategy/entries_example.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "engine/cost/route_entries.h"
#include "engine/search/greedy/greedy.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

class Entries : public Strategy {
 public:
  explicit Entries(const StrategyOptions& options) : order_(options.Choice("order")) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const LayerView layer(problem);
    Route start = BaselineRoute(layer, budget);
    if (order_ == "given") start = GivenRoute(*problem.plan);
    return Finish(layer, std::move(start), budget);
  }

  // The layer turned out to begin elsewhere: the order stays, the entries are chosen again.
  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    return Finish(LayerView(problem), start, budget);
  }

 private:
  static Solution Finish(const LayerView& layer, Route route, Budget& budget) {
    ChooseEntries(layer, route, budget);  // asks the budget itself, and never makes a route worse
    return Solution{std::move(route), StopOr(budget, StopReason::kLocalOptimum), std::nullopt};
  }

  const std::string order_;
};

}  // namespace

StrategyEntry EntriesEntry() {
  StrategyEntry entry;
  entry.name = "entries";
  entry.summary = "The order of greedy, or the one given, with the best entries for it.";
  OptionSpec order;
  order.name = "order";
  order.type = OptionSpec::Type::kChoice;
  order.default_value = "greedy";
  order.values = {"greedy", "given"};
  order.description = "Whose order is kept.";
  entry.options = {order};
  entry.make = [](const StrategyOptions& options) -> std::unique_ptr<Strategy> {
    return std::make_unique<Entries>(options);
  };
  return entry;
}

}  // namespace traverse
