// Turns a run of blocks: what remains of 2-opt where blocks cannot be reversed.
//
//   ... p | A  B  C | q ...   ->   ... p | C~ B~ A~ | q ...      each block turned as far as may be
//
// An island of interleaved deposition has its contours first, and a feature of a sliced file comes
// after those that it touches. The order of such blocks along a route can be turned round, but not
// the blocks themselves. 3-opt moves reverse all or nothing, so they turn no such run, and a route
// that goes round a layer the wrong way stays so.

#ifndef TRAVERSE_ENGINE_SEARCH_TURN_RUN_H_
#define TRAVERSE_ENGINE_SEARCH_TURN_RUN_H_

#include "engine/search/order_tree.h"
#include "engine/search/search_state.h"

namespace traverse {

// Whether TurnRun can turn runs of children of `node` that cannot be reversed.
bool TurnsOnly(const OrderTree& tree, int node);

// Puts the children of `node` at positions [first, last] in the opposite order, as far as their
// `before` pairs allow, and does the same within each child; reversible parts are reversed. Doing
// it twice is the identity if there are no pairs. O(size * depth + children^2 * pairs). REQUIRES:
// `node` has free order; [first, last] is a union of children of it.
void TurnRun(SearchState& state, int node, int first, int last);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_TURN_RUN_H_
