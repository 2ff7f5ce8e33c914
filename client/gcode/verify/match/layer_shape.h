// The shape of one layer of the original: what lies within its outer walls, point by point.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAYER_SHAPE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAYER_SHAPE_H_

#include <cstdint>
#include <vector>

#include "client/gcode/verify/match/layer_pair.h"
#include "client/gcode/verify/match/piece_tree.h"
#include "client/gcode/verify/match/plane.h"

namespace traverse::gcode {

class LayerShape {
 public:
  LayerShape() {}  // nothing
  explicit LayerShape(const LayerPair& layer);

  double z_mm() const { return z_mm_; }
  bool one_tool() const { return one_tool_; }

  // Filament in the outer walls, in mm per mm: what their width is known from.
  double filament_per_mm() const { return filament_per_mm_; }

  // Whether an odd number of closed outer walls is around `p`.
  bool IsWithin(Point p) const;

  // Whether an outer wall is nearer to `p` than `reach`.
  bool IsNearWall(Point p, double reach) const;

  // Whether an outer wall that is not closed comes nearer than `reach` to the line from `a` to `b`.
  bool MeetsOpenWall(Point a, Point b, double reach) const;

 private:
  size_t RowOf(double y) const;

  double z_mm_ = 0;
  bool one_tool_ = true;
  double filament_per_mm_ = 0;
  PieceTree walls_;
  PieceTree open_walls_;       // those of them that are not closed
  std::vector<Piece> rounds_;  // closed walls, with what closes them
  double low_y_ = 0;
  double row_mm_ = 1;
  std::vector<std::vector<uint32_t>> rows_;  // pieces of rounds_ that meet a row
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAYER_SHAPE_H_
