// A long search: many short walks from the best route, of which the best stretches remain.
//
//   shake    double bridges all over the best route, repaired together: another basin nearby
//   walk     iterated local search from there, until it gains nothing more
//   merge    what is better in the walk's route replaces what is worse in the best one
//            (merge_routes.h)
//
// One walk, however long, stays in the basin where it began: on a gear with 197 paths, those of
// four seeds end at the same route, 0.2 % above the optimum.

#ifndef TRAVERSE_ENGINE_SEARCH_LONG_LONG_SEARCH_H_
#define TRAVERSE_ENGINE_SEARCH_LONG_LONG_SEARCH_H_

#include <cstdint>

#include "engine/base/budget.h"
#include "engine/base/rng.h"
#include "engine/cost/neighbor_lists.h"
#include "engine/model/layer_problem.h"
#include "engine/search/iterated_search.h"
#include "engine/search/search_state.h"

namespace traverse {

struct LongSearchOptions {
  IteratedSearchOptions walk;

  // Iterations of all walks without a gain, or with less than least_gain of the cost, that end the
  // search.
  int64_t patience = 1000;
  double least_gain = 0;

  // Cuts of a shake, as a share of the paths that are kicked: least and most, with as many shakes
  // of one order of magnitude as of another.
  double least_shaken = 0.05;
  double most_shaken = 0.4;
};

// Improves the route of `state` and returns the iterations that it took. The route is never worse
// than before. `state` is one of `problem`.
int64_t SearchLong(const LayerProblem& problem, SearchState& state, const NeighborLists& neighbors,
                   const LongSearchOptions& options, Rng& rng, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_LONG_LONG_SEARCH_H_
