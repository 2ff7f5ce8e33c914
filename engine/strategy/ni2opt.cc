#include "engine/strategy/ni2opt.h"

#include <memory>
#include <optional>
#include <utility>

#include "engine/cost/route_cost.h"
#include "engine/search/greedy/greedy.h"
#include "engine/souza/descent.h"
#include "engine/souza/nearest_insertion.h"
#include "engine/souza/published.h"
#include "engine/strategy/stop.h"

namespace traverse {
namespace {

class Ni2opt : public Strategy {
 public:
  explicit Ni2opt(bool point_release) : Strategy({.quick = true}), descent_{point_release} {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    const LayerView layer(problem, &budget);
    Route baseline = BaselineRoute(layer, budget);
    const std::optional<Route> inserted = NearestInsertionRoute(layer, budget);
    if (!inserted) {
      return Solution{std::move(baseline), StopOr(budget, StopReason::kLocalOptimum), std::nullopt};
    }
    return Best(layer, std::move(baseline), *inserted, budget);
  }

  // Without construction: the order that was found for another start is a good one still.
  Solution Resume(const LayerProblem& problem, const Route& start, Budget& budget) const override {
    const LayerView layer(problem, &budget);
    Route baseline = BaselineRoute(layer, budget);
    return Best(layer, std::move(baseline), start, budget);
  }

 private:
  // Descends from `start`. If that ends above the baseline, the baseline replaces it: improved too,
  // but as it is if point release is off, which then is the NI2OPT of the sources. Never above
  // either.
  Solution Best(const LayerView& layer, Route baseline, const Route& start, Budget& budget) const {
    Route route = Improve(layer, start, descent_, budget);
    if (RouteCost(layer.problem, baseline, &budget) < RouteCost(layer.problem, route, &budget)) {
      route = descent_.point_release ? Improve(layer, baseline, descent_, budget) : baseline;
      // An improvement that rounding made a loss.
      route = Cheaper(layer, std::move(route), std::move(baseline), budget);
    }
    route = Cheaper(layer, std::move(route), start, budget);
    return Solution{std::move(route), StopOr(budget, StopReason::kLocalOptimum), std::nullopt};
  }

  static Route Cheaper(const LayerView& layer, Route first, Route second, Budget& budget) {
    const double least = RouteCost(layer.problem, first, &budget);
    return RouteCost(layer.problem, second, &budget) < least ? std::move(second) : std::move(first);
  }

  DescentOptions descent_;
};

// Metodo 2, or with point release Metodo 3, as published.
class PublishedNi2opt : public Strategy {
 public:
  explicit PublishedNi2opt(bool point_release)
      : Strategy({.serial = true, .pure = true}), point_release_(point_release) {}

  Solution Solve(const LayerProblem& problem, Budget& budget) const override {
    Route route = PublishedRoute(LayerView(problem, &budget), point_release_, budget);
    return Solution{std::move(route), StopOr(budget, StopReason::kLocalOptimum), std::nullopt};
  }

 private:
  const bool point_release_;
};

}  // namespace

StrategyEntry Ni2optEntry() {
  return StrategyEntry{
      "ni2opt",
      "Nearest insertion, then 2-opt and point release until neither finds a gain.",
      false,
      {BoolOption("point_release", true, "Alternate 2-opt with choosing the entries again."),
       PureOption(
           "Metodo 3 as published, or Metodo 2 without point release: rasters after the contours' "
           "2-opt, release once at the end, never a shorter route of another method.")},
      [](const StrategyOptions& options) -> std::unique_ptr<Strategy> {
        const bool release = options.Bool("point_release");
        if (options.Bool("pure")) return std::make_unique<PublishedNi2opt>(release);
        return std::make_unique<Ni2opt>(release);
      }};
}

}  // namespace traverse
