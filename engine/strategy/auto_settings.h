// How `auto` searches a layer, by what it has: measured on the literature's instances and on
// layers of parts.

#ifndef TRAVERSE_ENGINE_STRATEGY_AUTO_SETTINGS_H_
#define TRAVERSE_ENGINE_STRATEGY_AUTO_SETTINGS_H_

#include <algorithm>

#include "engine/model/layer_problem.h"
#include "engine/model/plan.h"
#include "engine/search/local_search.h"

namespace traverse {

struct AutoSettings {
  LocalSearchOptions local_search;

  // Iterations without a gain worth mentioning, for each path, after which the search ends.
  double patience = 6;
};

// Layers of more than 150 paths are searched wider and deeper: each kick costs more, and gains
// more. Among contours alone, looking only at edges that are new saves more time than it loses of
// the route, up to 250 of them without trial moves too; with rasters it ends 0.1 % longer.
inline AutoSettings SettingsFor(const Plan& plan) {
  constexpr size_t kFewPaths = 150;
  constexpr size_t kFewContours = 250;
  const size_t paths = plan.paths.size();
  const bool contours = std::none_of(plan.paths.begin(), plan.paths.end(), [](const Path& path) {
    return path.kind == Path::Kind::kOpen;
  });
  AutoSettings settings;
  settings.local_search.both_edges = !contours;
  if (paths <= kFewPaths) {
    settings.local_search.depth = 1;
    settings.local_search.three_opt.first_breadth = 6;
    settings.local_search.three_opt.second_breadth = 4;
    settings.patience = contours ? 13 : 11;
  } else if (contours && paths <= kFewContours) {
    settings.local_search.depth = 1;
    settings.patience = 9;
  }
  return settings;
}

// Iterations are counted, not timed, so that routes are the same on every machine.
inline constexpr double kIterationSeconds = 20e-6;

// What an iteration of a search must save to be worth its time, in the unit of the cost: a second
// of travel for a second of computing. 0 if the speed is 0, which stands for unknown, and for
// layers whose cost is not in its ordinary unit.
inline double WorthOfIteration(const LayerProblem& problem, double idle_speed_mm_s) {
  if (idle_speed_mm_s == 0 || problem.walls_unit != 1) return 0;
  const bool is_time = problem.cost.kind == CostSpec::Kind::kTime;
  return kIterationSeconds * (is_time ? 1 : idle_speed_mm_s);
}

// Iterations over which that is measured. With fewer, layers of twenty paths that are searched with
// those behind them end up to 1.3 % longer.
inline constexpr double kWorthWindow = 1000;

// Of a search that only mends a route that was good from another start.
inline constexpr double kWorthWindowOfMending = 300;

// Of the time of a search that ends when it is worth no more, what its bound may take.
inline constexpr double kWorthBoundShare = 0.25;

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_STRATEGY_AUTO_SETTINGS_H_
