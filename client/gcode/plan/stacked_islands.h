// The islands of all layers, and what each of them lies on.
//
// An island is a connected region of a layer: of paths that touch (precedence.h). It lies on the
// islands printed last before it wherever it is. These are mostly those of the layer before,
// but not where objects have layers of different heights, or are printed one after the other.
// Islands near each other also count as one (island_tree.h), in both layers.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_STACKED_ISLANDS_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_STACKED_ISLANDS_H_

#include <compare>
#include <cstdint>
#include <vector>

#include "client/gcode/island_tree.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

struct LayerIslands {
  // Node `island` of this layer lies on node `below` of the earlier layer `layer`.
  struct Support {
    uint32_t layer = 0;
    uint32_t below = 0;
    uint32_t island = 0;

    auto operator<=>(const Support&) const = default;
  };

  std::vector<uint32_t> island;  // [path]
  IslandTree tree;
  std::vector<Support> supports;  // ascending, each once
};

// [layer]. Two islands lie on each other if both have paths in a cell of 1 mm. O(n log n) in the
// length of the paths in mm and in their segments; memory beside the result is that of a map of
// the plate.
std::vector<LayerIslands> StackIslands(const GcodeFile& file, int threads);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_STACKED_ISLANDS_H_
