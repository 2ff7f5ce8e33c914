// Finds which boxes of two sets overlap.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_BOX_PAIRS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_BOX_PAIRS_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {

// The pairs (i, j), each once, where a[i] and b[j] have a point in common; empty boxes have
// none. About O(boxes + pairs), because a grid whose cells have the mean size of the boxes finds
// them.
std::vector<std::pair<uint32_t, uint32_t>> OverlappingBoxes(const std::vector<BoundingBox>& a,
                                                            const std::vector<BoundingBox>& b);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_BOX_PAIRS_H_
