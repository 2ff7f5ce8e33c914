// Turning a run of blocks: what is left of 2-opt where blocks cannot be reversed.
//
//   ... p | A  B  C | q ...   ->   ... p | C~ B~ A~ | q ...      each block turned as far as may be
//
// An island of interleaved deposition comes contours first, a feature of a sliced file after those
// that it touches: their order along a route can be turned round, they themselves cannot. 3-opt
// moves reverse all or nothing, so they turn no run of such blocks, and a route that goes round a
// layer the wrong way stays so.

#ifndef TRAVERSE_ENGINE_SEARCH_TURN_RUN_H_
#define TRAVERSE_ENGINE_SEARCH_TURN_RUN_H_

#include "engine/search/order_tree.h"
#include "engine/search/search_state.h"

namespace traverse {

// Whether runs of children of `node` can be turned by TurnRun but not be reversed.
bool TurnsOnly(const OrderTree& tree, int node);

// Puts the children of `node` at positions [first, last] in the opposite order, as far as their
// `before` pairs allow, and does the same within each child: what is reversible is reversed.
// Twice is the identity where there are no pairs. O(size * depth + children^2 * pairs).
// REQUIRES: `node` has free order; [first, last] is a union of children of it.
void TurnRun(SearchState& state, int node, int first, int last);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_TURN_RUN_H_
