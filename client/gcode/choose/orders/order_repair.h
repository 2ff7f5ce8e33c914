// Takes one link out of an order of a layer and keeps the rest of the order.
//
//   sliced   ... r b ... a s ...
//   order    ... a | b ...           the link from a to b has to go
//   instead  ... a s ... b ...       a with the path that follows it as sliced,
//            ... a ... r b ...       b with the path before it as sliced,
//            ... b a ...             or a few paths around the link as sliced
//
// Each pair of paths stays in the order in which it was, or is as sliced: what both orders keep to,
// the result keeps to.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_REPAIR_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_REPAIR_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/model/placed_path.h"

namespace traverse::gcode {

// A link of an order: from the end of one path to the begin of another, as they are placed.
struct LinkEnds {
  Placement from;
  Placement to;

  friend bool operator==(const LinkEnds&, const LinkEnds&) = default;

  template <typename H>
  friend H AbslHashValue(H hash, const LinkEnds& link) {
    return H::combine(std::move(hash), link.from.block, link.from.entry, link.to.block,
                      link.to.entry);
  }
};

using LinkSet = absl::flat_hash_set<LinkEnds>;

// Whether one of the links of `order` is in `links`.
bool HasAnyOf(const LayerOrder& order, const LinkSet& links);

// Two paths, numbered from 0 in their layer, the first of which comes before the second as sliced.
using PathPair = std::pair<uint32_t, uint32_t>;

// Whether one of `pairs` is the other way round in `order`. O(n) in both. REQUIRES: the paths of
// `order` are those of the layer that begins with block `first`.
bool BreaksAnyOf(const LayerOrder& order, uint32_t first, const std::vector<PathPair>& pairs);

// `order` with each of `pairs` the right way round: what lies between the two and comes before the
// second as sliced goes before both, all others behind. Where many pairs are not, what lies between
// the others of them is as sliced. O(n). REQUIRES: as above.
LayerOrder InOrderOf(LayerOrder order, uint32_t first, const std::vector<PathPair>& pairs);

// Orders like `order` without its link to place `place`; up to `reach` paths on either side of the
// link are as sliced in the last of them. O(size of the order). REQUIRES: both have the same paths,
// those of `sliced` ascend without a gap; 0 < place < order.size(); reach > 0.
std::vector<LayerOrder> OrdersWithoutLink(const LayerOrder& order, size_t place,
                                          const LayerOrder& sliced, size_t reach);

// `order` with the first path as sliced at its begin, or the last one at its end: so no path comes
// before one that it has to follow. REQUIRES: as above.
LayerOrder BegunAsSliced(const LayerOrder& order, const LayerOrder& sliced);
LayerOrder EndedAsSliced(const LayerOrder& order, const LayerOrder& sliced);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_REPAIR_H_
