// Polishing: local search over order and entries together, from routes found by another method.
//
// The thesis names this cure for its tabu search (5.2, p. 95-97, and 6.2): it removes bad contour
// points and crossing moves, and iterated local search finds what local search does not. It uses
// all vertices of the contours, not only those that a reduction left.

#ifndef TRAVERSE_ENGINE_SEARCH_POLISHER_H_
#define TRAVERSE_ENGINE_SEARCH_POLISHER_H_

#include <cstdint>

#include "engine/base/budget.h"
#include "engine/base/rng.h"
#include "engine/cost/layer_view.h"
#include "engine/cost/neighbor_lists.h"
#include "engine/model/route.h"
#include "engine/search/end_groups.h"
#include "engine/search/entries/leaf_entries.h"
#include "engine/search/order_tree.h"
#include "engine/search/search_state.h"

namespace traverse {

// What polishing several routes of one layer shares. Building it takes O(points log points).
class Polisher {
 public:
  // `layer` must outlive the polisher. If the budget runs out, the polisher knows fewer moves.
  Polisher(const LayerView& layer, Budget& budget);

  // A valid route that costs no more than `route`, which is valid: entries chosen exactly, then
  // local search until no near move helps.
  Route Descend(Route route, Budget& budget);

  // The same, then kicks and repairs until `patience` of them in a row gain nothing.
  Route Iterate(Route route, int64_t patience, Rng& rng, Budget& budget);

 private:
  const LayerView& layer_;
  const OrderTree tree_;
  const LeafEntries entries_;
  const EndGroups groups_;
  const NeighborLists neighbors_;
  SearchState state_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_POLISHER_H_
