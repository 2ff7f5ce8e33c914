// Travel that nobody sees: it lies within the part, nothing of it is left open by the layer above
// nor hangs over the one below, and it leads to no outer wall. Looked at point by point.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_HIDDEN_LINKS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_HIDDEN_LINKS_H_

#include <cstdint>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/verify/match/layer_pair.h"
#include "client/gcode/verify/match/layer_shape.h"

namespace traverse::gcode {

// A layer of the original and those beside it.
struct LayerShapes {
  const LayerShape& below;
  const LayerShape& here;
  const LayerShape& above;
};

// The links of the other file, within the layer, whose only move, behind what continues along the
// path before, is open travel of `longest_mm` at most that nobody sees. With
// `bends` it may have several where somebody would see the straight one. None if one of the layers
// beside is not where a layer would be, or the layer has several tools.
absl::flat_hash_set<uint32_t> HiddenLinksOf(const LayerPair& layer, const LayerShapes& shapes,
                                            double longest_mm, bool bends = false);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_HIDDEN_LINKS_H_
