// The walls of a layer that are seen on the print, and which ways lead across them.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_VISIBLE_WALLS_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_VISIBLE_WALLS_H_

#include <vector>

#include "client/gcode/model/outline.h"
#include "engine/geometry/wall_grid.h"

namespace traverse::gcode {

// Outer and overhanging walls, and loops without a name.
bool IsVisibleWall(Feature feature);

// Those among the outlines of one layer, as the search is told of them; `path` is the outline's
// index.
std::vector<Wall> VisibleWallsOf(const std::vector<Outline>& outlines);

class VisibleWalls {
 public:
  // At each end of a way so much of it is not looked at, but no more than a fifth: ways begin and
  // end at the middle of a line, which may be a wall itself or lie against one.
  static constexpr double kEndSlackMm = 0.25;

  // Of the outlines of one layer.
  explicit VisibleWalls(const std::vector<Outline>& outlines)
      : grid_(VisibleWallsOf(outlines), kEndSlackMm) {}

  // True if the straight way from `a` to `b` crosses one. Ends that lie on a wall, or against it,
  // do not. It is the function by which the search knows it.
  bool Crossed(Vertex a, Vertex b) const { return grid_.Crosses({a.x, a.y}, {b.x, b.y}); }

  // The same of a way with bends, near which it is looked at as well.
  bool CrossedByWay(const std::vector<Vertex>& way) const;

  const WallGrid& grid() const { return grid_; }

 private:
  WallGrid grid_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_VISIBLE_WALLS_H_
