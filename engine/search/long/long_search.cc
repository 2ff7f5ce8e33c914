#include "engine/search/long/long_search.h"

#include <algorithm>
#include <cmath>

#include "engine/base/tolerances.h"
#include "engine/cost/route_cost.h"
#include "engine/model/route.h"
#include "engine/search/long/merge_routes.h"

namespace traverse {
namespace {

constexpr int kCutsOfKick = 4;

int KicksOfShake(const LongSearchOptions& options, int kicked, Rng& rng) {
  const double ratio = options.most_shaken / options.least_shaken;
  const double share = options.least_shaken * std::pow(ratio, rng.Unit());
  return 1 + static_cast<int>(share * kicked / kCutsOfKick);
}

}  // namespace

int64_t SearchLong(const LayerProblem& problem, SearchState& state, const NeighborLists& neighbors,
                   const LongSearchOptions& options, Rng& rng, Budget& budget) {
  Route best = state.Unload();
  double cost_before = RouteCost(problem, best, &budget);  // when the patience began
  const int paths = state.tree().path_count();
  const int kicked = std::min(options.walk.last_kicked, paths) + 1 - options.walk.first_kicked;
  int64_t iterations = 0;
  for (int64_t idle = 0; idle < options.patience && !budget.Exhausted();) {
    IteratedSearch walk(state, neighbors, options.walk);
    walk.Shake(KicksOfShake(options, kicked, rng), rng, budget);
    walk.Run(rng, budget);
    iterations += walk.iterations();
    idle += walk.iterations();
    MergeRoutes(problem, state.Unload(), best, budget);
    const double cost = RouteCost(problem, best, &budget);
    if (cost_before - cost > options.least_gain * cost + kImprovementTolerance) {
      cost_before = cost;
      idle = 0;
    }
    state.Load(best, &budget);
  }
  return iterations;
}

}  // namespace traverse
