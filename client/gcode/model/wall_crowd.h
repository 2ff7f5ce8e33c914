// How crowded the walls of a layer are: more of them than a printer can lay into one place are
// known only from files that were made to keep a reader busy.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_WALL_CROWD_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_WALL_CROWD_H_

#include <cstddef>
#include <vector>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

class WallCrowd {
 public:
  // Length of walls in mm that a square millimeter takes. Lines of 0.4 mm side by side have 2.5;
  // the rest is for what is printed twice, and for the edges of the cells.
  static constexpr double kMostMmPerSquareMm = 40;

  // For walls in the box from `low` to `high`. REQUIRES: low <= high, both in x and in y.
  WallCrowd(Point low, Point high);

  // Adds the polyline and returns true if there is room for it everywhere; else changes nothing.
  // O(points + length).
  bool Takes(const std::vector<Point>& line);

 private:
  // Calls visit(cell, length in mm) for short pieces of the line.
  template <typename Visit>
  void ForEachPiece(const std::vector<Point>& line, Visit visit) const;

  Point low_;
  double cell_mm_;
  size_t columns_;
  size_t rows_;
  std::vector<float> length_mm_;  // [row * columns_ + column] of the walls in this cell
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_WALL_CROWD_H_
