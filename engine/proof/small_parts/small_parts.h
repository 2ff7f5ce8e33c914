// Small parts of a plan, solved to optimality by dynamic programming over subsets.
//
//   any_order(a, b, c):   {}  ->  {a}, {b}, {c}  ->  {a,b}, {a,c}, {b,c}  ->  {a,b,c}
//
// Computes the least cost for each set of finished children and each entry of the last path
// (Bellman 1962; Held and Karp 1962). A child with paths of its own is solved in the same way for
// each set before it, an in_order one child after the other: the result is exact for any tree. With
// k children of m entries, time is about m^2 k^2 2^k / 4: 1 ms for 6 contours of 40 vertices or 12
// open paths.
//
// This uses no linear programmes, so every strategy can end with it.

#ifndef TRAVERSE_ENGINE_PROOF_SMALL_PARTS_SMALL_PARTS_H_
#define TRAVERSE_ENGINE_PROOF_SMALL_PARTS_SMALL_PARTS_H_

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

struct SmallPartOptions {
  int most_children = 12;        // of an any_order node
  double most_operations = 1e7;  // of all parts, shared in proportion to their paths: about 20 ms
};

// Whether the whole plan is small: SolveSmallParts then solves all of it. O(nodes).
bool IsSmall(const LayerView& layer, const SmallPartOptions& options, Budget* budget = nullptr);

// In the part of `route` below each node that is small enough and has no small node above it,
// replaces orders and entries by the best ones between the visits before and after it. Never makes
// the route longer. True if the whole plan is small, and `route` therefore optimal; false too if
// the budget ended it. REQUIRES: `route` is a route of the layer's plan.
bool SolveSmallParts(const LayerView& layer, const SmallPartOptions& options, Route& route,
                     Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_SMALL_PARTS_SMALL_PARTS_H_
