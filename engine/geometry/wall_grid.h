// The walls of a layer in a grid of cells, which finds the walls that a straight move crosses.
//
// The cells are as large as the mean length of the segments. So n segments take O(n) memory, and a
// test looks only at the few segments in the cells that the move passes. A layer without walls near
// a move costs almost nothing.

#ifndef TRAVERSE_ENGINE_GEOMETRY_WALL_GRID_H_
#define TRAVERSE_ENGINE_GEOMETRY_WALL_GRID_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/rest.h"
#include "engine/geometry/bounding_box.h"
#include "engine/model/point.h"
#include "engine/model/walls.h"

namespace traverse {

// The straight line between two neighboring points of a wall.
struct WallSegment {
  Point a;
  Point b;
  uint32_t wall = 0;  // index into the given walls
};

// True if the segments ab and cd cross at one point inside ab. If a line from a to b passes a point
// where two other segments meet from either side of it, it crosses one of these.
inline bool SegmentsCross(Point a, Point b, Point c, Point d) {
  const auto turn_at = [](Point p, Point q, Point r) {
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  };
  // What is so near to the line lies on it: a way along a wall does not cross it.
  constexpr double kTouchMm = 1e-7;
  const double touch = kTouchMm * (std::abs(b.x - a.x) + std::abs(b.y - a.y));
  if ((turn_at(a, b, c) < -touch) == (turn_at(a, b, d) < -touch)) return false;
  const double of_a = turn_at(c, d, a);
  const double of_b = turn_at(c, d, b);
  return (of_a < 0 && of_b > 0) || (of_a > 0 && of_b < 0);
}

// Which ends of a straight line from a to b are ends of the move that it belongs to: at a bend of a
// move nothing is ignored.
struct MoveEnds {
  bool a = true;
  bool b = true;
};

// Immutable. The segments of a wall follow one another, without those of length zero.
class WallGrid {
 public:
  // Ignores `slack_mm` at each end of a move, but no more than a fifth of it: moves begin and end
  // on lines that may be walls themselves, or touch them. Asks `budget` regularly, if it is not
  // null. O(n) for n points.
  WallGrid(absl::Span<const Wall> walls, double slack_mm, Budget* budget = nullptr);

  const std::vector<WallSegment>& segments() const { return segments_; }

  // The segments of one of the given walls: [first, second).
  std::pair<uint32_t, uint32_t> SegmentsOf(uint32_t wall) const {
    return {first_of_wall_[wall], first_of_wall_[wall + size_t{1}]};
  }

  // Whether a move, without its ignored ends, crosses a wall. The same in both directions.
  bool Crosses(Point a, Point b, MoveEnds ends = {}) const;

  // The move without its ignored ends.
  std::pair<Point, Point> WithoutEnds(Point a, Point b, MoveEnds ends = {}) const;

  // Calls visit(index of a segment) for all segments that may come as near as `beside_mm` to the
  // straight line from `a` to `b`, for some more than once, until it returns false. 0: that may
  // meet it.
  template <typename Visit>
  void ForEachOnLine(Point a, Point b, Visit visit, double beside_mm = 0) const;

 private:
  // The cell of `count` in which a position lies, or the nearest to it.
  static int Cell(double position, int count) {
    return static_cast<int>(std::clamp(position, 0.0, count - 1.0));
  }
  int Row(double y) const { return Cell((y - low_.y) * per_mm_, rows_); }

  // Calls visit(row, first column, last column) for the rows of cells that contain the line, or
  // are as near to it as `beside_mm`, until it returns false.
  template <typename Visit>
  void ForEachRow(Point a, Point b, double beside_mm, Visit visit) const;
  void SizeCells(Rest& rest);
  void Fill(Rest& rest);

  const double slack_mm_;
  std::vector<WallSegment> segments_;
  std::vector<uint32_t> first_of_wall_;  // [wall]; one more
  BoundingBox box_;
  Point low_;
  double cell_mm_ = 1;
  double per_mm_ = 1;  // 1 / cell_mm_
  int columns_ = 0;
  int rows_ = 0;
  std::vector<uint32_t> first_;    // [row * columns_ + column] in entries_; one more
  std::vector<uint32_t> entries_;  // segments, by cell
};

template <typename Visit>
void WallGrid::ForEachRow(Point a, Point b, double beside_mm, Visit visit) const {
  // More than rounding can shift a point of the line.
  constexpr double kSlack = 1e-6;
  const double beside = beside_mm + kSlack;
  if (a.y > b.y) std::swap(a, b);
  const int first = Row(a.y - beside);
  const int last = Row(b.y + beside);
  const double left = (std::min(a.x, b.x) - beside - low_.x) * per_mm_;
  const double right = (std::max(a.x, b.x) + beside - low_.x) * per_mm_;
  if (first == last || b.y - a.y <= kSlack) {
    for (int row = first; row <= last; ++row) {
      if (!visit(row, Cell(left, columns_), Cell(right, columns_))) return;
    }
    return;
  }
  // Within a row the line lies between where it passes the row's two borders, in columns of cells.
  const double slope = (b.x - a.x) / (b.y - a.y);
  const double wide = std::abs(slope);
  const double slack = beside * per_mm_ * (1 + wide);
  const double least =
      (a.x - low_.x - slope * (a.y - low_.y)) * per_mm_ - slack + std::min(slope, 0.0);
  const double most = least + 2 * slack + wide;
  for (int row = first; row <= last; ++row) {
    const double x = slope * row;
    const int begin = Cell(std::max(least + x, left), columns_);
    if (!visit(row, begin, Cell(std::min(most + x, right), columns_))) return;
  }
}

template <typename Visit>
void WallGrid::ForEachOnLine(Point a, Point b, Visit visit, double beside_mm) const {
  if (segments_.empty()) return;
  if (std::max(a.x, b.x) < box_.low().x - beside_mm ||
      std::min(a.x, b.x) > box_.high().x + beside_mm ||
      std::max(a.y, b.y) < box_.low().y - beside_mm ||
      std::min(a.y, b.y) > box_.high().y + beside_mm) {
    return;
  }
  ForEachRow(a, b, beside_mm, [&](int row, int first, int last) {
    const size_t cell = static_cast<size_t>(row) * static_cast<size_t>(columns_);
    const uint32_t begin = first_[cell + static_cast<size_t>(first)];
    const uint32_t end = first_[cell + static_cast<size_t>(last) + 1];
    for (uint32_t i = begin; i < end; ++i) {
      if (!visit(entries_[i])) return false;
    }
    return true;
  });
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_WALL_GRID_H_
