// Polishing: local search over order and entries together, from routes found otherwise.
//
// The cure that the thesis names for its tabu search (5.2, p. 95-97, and 6.2): bad contour points
// and crossing moves go, and what local search does not find, iterated local search does. All
// vertices of the contours count, not those of a reduction alone.

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

// What polishing several routes of one layer shares. Setting it up takes O(points log points).
class Polisher {
 public:
  // `layer` outlives the polisher. When the budget runs out, it knows of fewer moves.
  Polisher(const LayerView& layer, Budget& budget);

  // A valid route that costs no more than `route`, which is valid: entries chosen exactly, then
  // local search until nothing near helps.
  Route Descend(Route route, Budget& budget);

  // The same, and then kicks and repairs until `patience` of them in a row gained nothing.
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
