// Orders of a layer that come to its islands in other sequences.
//
// Whether islands rest long enough (island_rests.h) depends on where a layer begins and in which
// direction it goes round, and hardly on the paths within an island. So an order that saves travel
// but prints an island again too soon is also tried turned and begun elsewhere:
//
//   as found                          c d a b
//   begun where the file begins       a b c d
//   the same, the other way round     a d c b
//   in the sequence of the file       a c b d
//
// If all layers begin where the file does and go the same way round, islands rest about as long as
// in the file.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ISLAND_ORDERS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ISLAND_ORDERS_H_

#include <cstdint>
#include <vector>

#include "client/gcode/write/placed_path.h"

namespace traverse::gcode {

// The parts of a layer, by path: the island that it lies in, and the group that it does not leave.
struct IslandParts {
  std::vector<uint32_t> island;
  std::vector<uint32_t> group;  // LayerFreedom::group
};

// The three sequences above, islands one by one within each group, each island's paths as in
// `found`. `given` is the file's own order. Empty if the layer has one island only. O(n log n).
std::vector<LayerOrder> IslandOrders(const LayerOrder& given, const LayerOrder& found,
                                     const IslandParts& parts);

// [path] numbers of what must stay together for an order to keep its sequence of islands.
std::vector<uint32_t> IslandGroups(const IslandParts& parts);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ISLAND_ORDERS_H_
