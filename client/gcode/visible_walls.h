// The walls of a layer that are seen on the print, and which ways lead across them.

#ifndef TRAVERSE_CLIENT_GCODE_VISIBLE_WALLS_H_
#define TRAVERSE_CLIENT_GCODE_VISIBLE_WALLS_H_

#include <utility>
#include <vector>

#include "client/gcode/outline.h"
#include "client/gcode/segment_grid.h"

namespace traverse::gcode {

class VisibleWalls {
 public:
  // Outer and overhanging walls, and loops without a name, among the outlines of one layer.
  explicit VisibleWalls(const std::vector<Outline>& outlines);

  // True if the straight way from `a` to `b` crosses one. Ends that lie on a wall, or against it,
  // do not.
  bool Crossed(Vertex a, Vertex b) const;

  // The part of that way that is looked at: without its ends.
  static std::pair<Vertex, Vertex> Shortened(Vertex a, Vertex b);

  const SegmentGrid& grid() const { return grid_; }

 private:
  SegmentGrid grid_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VISIBLE_WALLS_H_
