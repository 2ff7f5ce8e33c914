// Merges two routes of a layer: of stretches over which both visit the same paths, the one that
// costs less remains.
//
//   route    ... a [ 1 2 3 4 ] b ...   ->   ... a [ 3 1 2 4 ] b ...
//   other    ... c [ 3 1 2 4 ] d ...        or 4 2 1 3, whichever costs less
//
// Two local optima agree in most places, and in some of the others each is the better one. Such
// stretches are the parts of partition crossover (Whitley, Hains and Howe 2009) that a route enters
// once. With entries as they are; O(n * longest stretch) for n paths, of which few are compared.

#ifndef TRAVERSE_ENGINE_SEARCH_LONG_MERGE_ROUTES_H_
#define TRAVERSE_ENGINE_SEARCH_LONG_MERGE_ROUTES_H_

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"

namespace traverse {

// Makes `route` the cheaper one of both, and then takes stretches of the other one as long as that
// makes it cheaper. REQUIRES: both are valid.
void MergeRoutes(const LayerProblem& problem, Route other, Route& route, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_LONG_MERGE_ROUTES_H_
