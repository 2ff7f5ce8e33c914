// The segments of a layer's paths in a grid of square cells, to find what is near what.

#ifndef TRAVERSE_CLIENT_GCODE_SEGMENT_GRID_H_
#define TRAVERSE_CLIENT_GCODE_SEGMENT_GRID_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "client/gcode/outline.h"

namespace traverse::gcode {

struct Segment {
  Vertex a;
  Vertex b;
  uint32_t path = 0;  // index of the outline that it is of
};

// Smallest distance between two segments in mm, squared; 0 if they cross.
double SquaredDistance(const Segment& s, const Segment& t);

// True if the insides of the segments cross at one point.
bool Cross(Vertex a, Vertex b, Vertex c, Vertex d);

// Built once; O(total length of the segments / cell size) in time and memory.
class SegmentGrid {
 public:
  // Cells of kCellMm; a layer of huge extent gets larger ones, so that there are at most kMaxCells,
  // and no more than pay for so few segments.
  static constexpr double kCellMm = 1;
  static constexpr size_t kMaxCells = size_t{1} << 22;
  static constexpr size_t kCellsPerSegment = 256;

  explicit SegmentGrid(std::vector<Segment> segments);

  const std::vector<Segment>& segments() const { return segments_; }
  double cell_mm() const { return cell_; }

  // Calls visit(s, t), indices of two segments, for all pairs closer to each other than a cell, and
  // for some that are not; for some more than once. s and t are of different paths.
  template <typename Visit>
  void ForEachNearPair(Visit visit) const;

  // Calls visit(s) for all segments that the straight way from `a` to `b` may cross, until it
  // returns false.
  template <typename Visit>
  void ForEachOnWay(Vertex a, Vertex b, Visit visit) const;

 private:
  int Column(double x) const;
  int Row(double y) const;
  size_t Cell(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
  }

  // Calls visit(column, row) for the cells along a segment, each once in a row.
  template <typename Visit>
  void ForEachCell(Vertex a, Vertex b, Visit visit) const;
  void Fill();

  template <typename Visit>
  void VisitCells(size_t one, size_t other, Visit& visit) const;

  std::vector<Segment> segments_;
  double cell_ = kCellMm;
  double min_x_ = 0;
  double min_y_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<uint32_t> first_;    // [cell] where its entries begin; one more at the end
  std::vector<uint32_t> entries_;  // segments, by cell
};

template <typename Visit>
void SegmentGrid::ForEachCell(Vertex a, Vertex b, Visit visit) const {
  // Samples a quarter of a cell apart: a cell of which only a corner is touched may be missed, by
  // less than an eighth of its side.
  const double length = Distance(a, b);
  const int steps = static_cast<int>(length * 4 / cell_) + 1;
  int last_column = -1;
  int last_row = -1;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const int column = Column(a.x + (b.x - a.x) * t);
    const int row = Row(a.y + (b.y - a.y) * t);
    if (column == last_column && row == last_row) continue;
    last_column = column;
    last_row = row;
    visit(column, row);
  }
}

template <typename Visit>
void SegmentGrid::VisitCells(size_t one, size_t other, Visit& visit) const {
  for (uint32_t i = first_[one]; i < first_[one + 1]; ++i) {
    const uint32_t s = entries_[i];
    for (uint32_t j = one == other ? i + 1 : first_[other]; j < first_[other + 1]; ++j) {
      const uint32_t t = entries_[j];
      if (segments_[s].path != segments_[t].path) visit(s, t);
    }
  }
}

template <typename Visit>
void SegmentGrid::ForEachNearPair(Visit visit) const {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const size_t cell = Cell(column, row);
      if (first_[cell] == first_[cell + 1]) continue;
      VisitCells(cell, cell, visit);
      if (column + 1 < columns_) VisitCells(cell, Cell(column + 1, row), visit);
      if (row + 1 == rows_) continue;
      if (column > 0) VisitCells(cell, Cell(column - 1, row + 1), visit);
      VisitCells(cell, Cell(column, row + 1), visit);
      if (column + 1 < columns_) VisitCells(cell, Cell(column + 1, row + 1), visit);
    }
  }
}

template <typename Visit>
void SegmentGrid::ForEachOnWay(Vertex a, Vertex b, Visit visit) const {
  if (columns_ == 0) return;
  bool going_on = true;
  ForEachCell(a, b, [&](int column, int row) {
    for (int r = row > 0 ? row - 1 : row; going_on && r <= row + 1 && r < rows_; ++r) {
      for (int c = column > 0 ? column - 1 : column; c <= column + 1 && c < columns_; ++c) {
        const size_t cell = Cell(c, r);
        for (uint32_t i = first_[cell]; going_on && i < first_[cell + 1]; ++i) {
          going_on = visit(entries_[i]);
        }
      }
    }
  });
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_SEGMENT_GRID_H_
