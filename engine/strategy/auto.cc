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

// Iterations without a gain worth mentioning after which the search ends: so many, which more
// effort does not raise, and so many more a path.
constexpr double kLeastPatience = 100;
constexpr double kPatience = 1;
constexpr double kLeastGain = 2e-4;

// Paths times leaves between the cuts of the widest kicks.
constexpr int kWidestKicks = 200'000;
constexpr int kMostSpan = 400;
constexpr int kLeastMostSpan = 50;

// Operations of dynamic programmes on small parts, by the way of 2 ns each.
constexpr double kSmallPartOperations = 3e6;

// Of a search that starts from a route that was good from another start.
constexpr double kResumeShare = 0.2;

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
    const int paths = tree.path_count();
    options.patience =
        static_cast<int64_t>(std::min(effort, 1.0) * kLeastPatience + effort * kPatience * paths);
    options.least_gain = kLeastGain;
    options.most_span = std::clamp(kWidestKicks / paths, kLeastMostSpan, kMostSpan);
    const NeighborLists neighbors =
        FindNeighbors(tree, groups, options.local_search.three_opt.first_breadth, budget);
    IteratedSearch search(state, neighbors, options);
    search.Descend(budget);
    Rng rng(layer.problem.seed);
    search.Run(rng, budget);
    Route improved = state.Unload();
    ChooseEntries(layer, improved, budget);
    SmallPartOptions small;
    small.most_operations = kSmallPartOperations * std::min(effort, 4.0);
    const bool optimal = SolveSmallParts(layer, small, improved, budget);
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
