// The walls of a layer that are visible on the print, and the moves that cross them.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_VISIBLE_WALLS_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_VISIBLE_WALLS_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gcode/model/outline.h"
#include "engine/geometry/wall_grid.h"

namespace traverse::gcode {

// Outer and overhanging walls, and loops without a name.
bool IsVisibleWall(Feature feature);

// Those among the outlines of one layer, in the form sent to the search; `path` is the outline's
// index. Without those that come to a place that has more of them than can be printed there
// (WallCrowd): a test of a travel move looks at all that are near.
std::vector<Wall> VisibleWallsOf(const std::vector<Outline>& outlines);

// A straight travel move.
struct TravelLine {
  Point from;
  Point to;
};

class VisibleWalls {
 public:
  // Ignored at each end of a move, but no more than a fifth of it: moves begin and end in the
  // middle of a line, which may be a wall itself or touch one.
  static constexpr double kEndSlackMm = 0.25;

  // The walls among the outlines of one layer.
  explicit VisibleWalls(const std::vector<Outline>& outlines);

  // True if the straight move from `a` to `b` crosses one. Ends that lie on a wall, or touch it, do
  // not count. The search uses the same function.
  bool Crossed(Point a, Point b) const { return grid_.Crosses(a, b); }

  // True if a move by these points, without its ends, comes nearer to one than half its width, and
  // nearer than both ends, or again after it was away from that of an end: as slicers' own
  // unretracted travel does not. So a move along a wall, from line to line beside it, does not
  // touch it. REQUIRES: two points at the least.
  bool Touched(absl::Span<const Point> travel) const;

  // Crossed for a move with bends, near which it is tested too.
  bool CrossedByTravel(const std::vector<Point>& travel) const;

  // The same for the moves of a travel move, of which some may be left out.
  bool CrossedByMoves(const std::vector<TravelLine>& moves) const;

  // True if `point` lies in the middle of one.
  bool IsOnOne(Point point) const;

  const WallGrid& grid() const { return grid_; }

 private:
  VisibleWalls(const std::vector<Outline>& outlines, const std::vector<Wall>& walls);

  // From `point` to a segment of `wall`; `most_mm` if none is nearer.
  double DistanceMm(uint32_t wall, Point point, double most_mm) const;

  // True if a move by `line`, which on leg `leg`, from 1, is beside `to`, was away from its wall
  // before.
  bool ComesBack(const std::vector<Point>& line, size_t leg, const WallSegment& to,
                 double half_mm) const;

  WallGrid grid_;
  std::vector<double> half_mm_;  // [wall of grid_]: half the width of its line
  double widest_half_mm_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_VISIBLE_WALLS_H_
