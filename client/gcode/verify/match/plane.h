// Distances and crossings in the plane, and a grid that finds near pieces.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PLANE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PLANE_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

inline double DistanceOf(Point a, Point b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  return std::sqrt(dx * dx + dy * dy);
}

// From `p` to the straight line between `a` and `b`.
double DistanceToPiece(Point p, Point a, Point b);

// Between two straight lines; 0 if they cross.
double DistanceOfPieces(Point a, Point b, Point c, Point d);

// True if the line from `c` to `d` crosses the other one at a point inside that. Where a line
// passes a point at which two others meet from either side of it, it crosses one of these.
bool PiecesCross(Point a, Point b, Point c, Point d);

// A straight piece of a path.
struct Piece {
  Point a;
  Point b;
  uint32_t path = 0;
};

// Appends the pieces of `path`: arcs become chords that lie within about 0.01 mm of them.
void AppendPieces(const TraceChunk& chunk, uint32_t path, std::vector<Piece>& pieces);

// A piece of more than one path.
inline constexpr uint32_t kSeveralPaths = UINT32_MAX;

// Leaves one of those that lie in the same place: loops may be printed there again and again.
void JoinEqual(std::vector<Piece>& pieces);

// Finds pieces by position. Cells have the requested width, or more if the pieces are long or lie
// far apart. Memory: some hundred bytes per piece at most.
class PieceGrid {
 public:
  PieceGrid(std::vector<Piece> pieces, double cell_mm);

  const std::vector<Piece>& pieces() const { return pieces_; }
  bool empty() const { return pieces_.empty(); }

  // Calls visit(index) for the pieces in cells that meet the box of `a` and `b`, widened by
  // `reach`; for some more than once. Stops when visit returns false.
  template <typename Visit>
  void ForEachNear(Point a, Point b, double reach, Visit visit) const {
    ForEachCellNear(a, b, reach, [&](size_t, absl::Span<const uint32_t> in_cell) {
      return std::all_of(in_cell.begin(), in_cell.end(), visit);
    });
  }

  // The same cell by cell: visit(cell, indices), also for cells without pieces.
  template <typename Visit>
  void ForEachCellNear(Point a, Point b, double reach, Visit visit) const {
    if (empty()) return;
    const int x_end = CellX(std::max(a.x, b.x) + reach);
    const int y_end = CellY(std::max(a.y, b.y) + reach);
    for (int y = CellY(std::min(a.y, b.y) - reach); y <= y_end; ++y) {
      for (int x = CellX(std::min(a.x, b.x) - reach); x <= x_end; ++x) {
        const size_t cell =
            static_cast<size_t>(y) * static_cast<size_t>(columns_) + static_cast<size_t>(x);
        const absl::Span<const uint32_t> entries = absl::MakeSpan(entries_);
        if (!visit(cell, entries.subspan(begin_[cell], begin_[cell + 1] - begin_[cell]))) return;
      }
    }
  }

  size_t cell_count() const { return static_cast<size_t>(columns_) * static_cast<size_t>(rows_); }

  // The same for the cells along the move from `a` to `b`.
  template <typename Visit>
  void ForEachAlong(Point a, Point b, Visit visit) const {
    if (empty()) return;
    bool go_on = true;
    ForEachCell(a, b, [&](size_t cell) {
      for (uint32_t i = begin_[cell]; go_on && i < begin_[cell + 1]; ++i) {
        go_on = visit(entries_[i]);
      }
    });
  }

 private:
  // Moves may lead farther than an int can count cells.
  static int Clamped(double cell, int count) {
    return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
  }
  int CellX(double x) const { return Clamped((x - low_.x) / cell_mm_, columns_); }
  int CellY(double y) const { return Clamped((y - low_.y) / cell_mm_, rows_); }

  // Row by row: the cells between where the move enters the row and where it leaves it.
  template <typename Visit>
  void ForEachCell(Point a, Point b, Visit visit) const {
    if (a.y > b.y) std::swap(a, b);
    const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
    const int last = CellY(b.y);
    for (int row = CellY(a.y); row <= last; ++row) {
      const double y_low = std::max(a.y, low_.y + row * cell_mm_);
      const double y_high = std::min(b.y, low_.y + (row + 1) * cell_mm_);
      double x_from = b.y > a.y ? a.x + (y_low - a.y) * slope : a.x;
      double x_to = b.y > a.y ? a.x + (y_high - a.y) * slope : b.x;
      if (row == last) x_to = b.x;
      if (x_from > x_to) std::swap(x_from, x_to);
      const int end = CellX(x_to + 1e-9);
      for (int column = CellX(x_from - 1e-9); column <= end; ++column) {
        visit(static_cast<size_t>(row) * static_cast<size_t>(columns_) +
              static_cast<size_t>(column));
      }
    }
  }

  std::vector<Piece> pieces_;
  std::vector<uint32_t> begin_;  // [cell] in entries_
  std::vector<uint32_t> entries_;
  Point low_;
  double cell_mm_;
  int columns_ = 1;
  int rows_ = 1;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_PLANE_H_
