// Where the part of a layer is, as far as that is certain: within its visible walls.

#ifndef TRAVERSE_CLIENT_GCODE_HIDDEN_LAYER_COVER_H_
#define TRAVERSE_CLIENT_GCODE_HIDDEN_LAYER_COVER_H_

#include <vector>

#include "client/gcode/hidden/cell_rows.h"
#include "client/gcode/model/outline.h"

namespace traverse::gcode {

// The cells are as large as that.
inline constexpr double kCoverCellMm = 0.1;

// In cells, each of which belongs to a set with all of its area.
struct LayerCover {
  CellRows inside;  // within visible walls, and nowhere nearer than half a width to one
  CellRows near;    // the other cells: at least in a corner nearer than that
  CellRows cover;   // `inside`, and where the lines of closed ones of these walls are

  bool empty() const { return inside.box().rows == 0; }
};

// An area is inside if an odd number of closed visible walls is around it, if visible walls, closed
// or not, part it from what lies outside of all of them, and if anything of the part but such walls
// is printed in it. So a hole counts as none of the part though its wall is printed in pieces,
// and so does what lies between a part and a shield around it. Empty if the layer has no visible
// walls, or too many in one place, or is too large. O(cells / 64 + n log n)
// for n cells on walls.
LayerCover CoverOf(const std::vector<Outline>& outlines);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_HIDDEN_LAYER_COVER_H_
