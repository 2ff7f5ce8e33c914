#include "engine/strategy/auto.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/construct/greedy.h"
#include "engine/cost/layer_view.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/route_entries.h"
#include "engine/exact/small_parts.h"
#include "engine/local_search/end_groups.h"
#include "engine/local_search/iterated_search.h"
#include "engine/local_search/leaf_entries.h"
#include "engine/local_search/order_tree.h"
#include "engine/local_search/search_state.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

// Iterations without a gain after which the search ends: so many a path.
constexpr double kPatience = 1;

// Of a search that starts from a route that was good from another start.
constexpr double kResumeShare = 0.5;

class Auto : public Strategy {
 public:
  Auto(double effort, bool bound) : effort_(effort), bound_(bound) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const LayerView layer(problem);
    return Search(layer, BaselineRoute(layer, budget), effort_, budget);
  }

  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    return Search(LayerView(problem), start, effort_ * kResumeShare, budget);
  }

  bool reuses_routes() const override { return true; }

  bool wants_bound() const override { return bound_; }

 private:
  Solution Search(const LayerView& layer, Route route, double effort, Budget& budget) const {
    const OrderTree tree(layer.plan());
    ChooseEntries(layer, route, budget);
    if (!tree.has_choice()) {
      const double cost = RouteCost(layer.problem, route);
      if (budget.was_exhausted()) return Finish(std::move(route), 0, budget);
      // The order is fixed, and a route of up to one window has the best entries.
      if (route.size() <= static_cast<size_t>(kEntryWindow))
        return Solution{std::move(route), StopReason::kOptimal, cost};
      return Finish(std::move(route), 0, budget);
    }
    const LeafEntries entries(layer.problem);
    SearchState state(layer.problem, tree, entries);
    state.Load(route);
    const EndGroups groups(entries);
    IteratedSearchOptions options;
    options.patience = static_cast<int64_t>(kPatience * effort * tree.path_count());
    const NeighborLists neighbors =
        FindNeighbors(tree, groups, options.local_search.three_opt.first_breadth, budget);
    IteratedSearch search(state, neighbors, options);
    search.Descend(budget);
    Rng rng(layer.problem.seed);
    search.Run(rng, budget);
    Route improved = state.Unload();
    ChooseEntries(layer, improved, budget);
    const bool optimal = SolveSmallParts(layer, SmallPartOptions(), improved, budget);
    Solution solution = Finish(std::move(improved), search.iterations(), budget);
    if (optimal) {
      solution.stop = StopReason::kOptimal;
      solution.lower_bound = RouteCost(layer.problem, solution.route);
    }
    return solution;
  }

  static Solution Finish(Route route, int64_t iterations, const Budget& budget) {
    return Solution{std::move(route),
                    StopOr(budget, StopReason::kLocalOptimum),
                    std::nullopt,
                    {{"iterations", static_cast<double>(iterations)}}};
  }

  const double effort_;
  const bool bound_;
};

}  // namespace

StrategyEntry AutoEntry() {
  return StrategyEntry{
      "auto",
      "The best route for the time given: greedy, improved until nothing more is gained.",
      true,
      {OptionSpec{"effort",
                  OptionSpec::Type::kDouble,
                  "1",
                  0,
                  1e6,
                  {},
                  "How long to go on without a gain, as a multiple of the default."},
       BoundOption(true)},
      [](const StrategyOptions& options) -> std::unique_ptr<Strategy> {
        return std::make_unique<Auto>(options.Double("effort"), options.Bool("bound"));
      }};
}

}  // namespace traverse
