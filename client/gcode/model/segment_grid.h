// The segments of a layer's paths in a grid of square cells, which finds segments near each other.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_SEGMENT_GRID_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_SEGMENT_GRID_H_

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

struct Segment {
  Point a;
  Point b;
  uint32_t path = 0;  // index of its outline
};

// Least distance between two segments in mm, squared; 0 if they cross.
double SquaredDistance(const Segment& s, const Segment& t);

// True if the interiors of the segments cross at one point.
bool Cross(Point a, Point b, Point c, Point d);

// Adds those between the points of `line`, the shape of `path`.
void AddSegments(const std::vector<Point>& line, uint32_t path, std::vector<Segment>& segments);

// Built once; O(total length of the segments / cell size + cells / 64) in time and memory, where
// the length is at most kCellsPerSegment cells for each segment.
class SegmentGrid {
 public:
  // Cells of `cell_mm`. A huge layer gets larger ones, so that there are at most kMaxCells, and
  // neither cells nor segments in them are more than so few segments justify.
  static constexpr double kCellMm = 1;
  static constexpr size_t kMaxCells = size_t{1} << 22;
  static constexpr size_t kCellsPerSegment = 256;

  // Segments to look at for each of a layer: far more than a printable layer needs. Where thousands
  // of paths lie in one place, what is asked of them is told as far as this reaches.
  static constexpr size_t kLooksPerSegment = 250;

  explicit SegmentGrid(std::vector<Segment> segments, double cell_mm = kCellMm);

  const std::vector<Segment>& segments() const { return segments_; }

  // Calls visit(s, t), indices of two segments of different paths i and j, for all pairs as near to
  // each other as reach(i, j), and for some others; for some more than once. Asks reach again for
  // each two cells that contain both paths. It is in mm, at most three quarters of a cell; negative
  // means that nothing is near. When visit returns false, goes on with the next two paths or cells.
  // Segments of one path follow one another in `segments`. Of two paths that are near each other in
  // two cells, nothing is visited there unless wanted(i, j). Returns false, and calls nothing, if
  // there are more than `most` pairs of paths to look at, counting each once per two adjacent
  // cells.
  template <typename Reach, typename Wanted, typename Visit>
  bool ForEachNearPair(Reach reach, Wanted wanted, Visit visit,
                       double most = std::numeric_limits<double>::infinity()) const;

  // The number of segments in all cells, each counted once per cell.
  size_t entry_count() const { return entries_.size(); }

  // Calls visit(s) for all segments that the straight move from `a` to `b` may cross, until it
  // returns false or `looks`, which each call takes one off, is 0.
  template <typename Visit>
  void ForEachOnTravel(Point a, Point b, size_t& looks, Visit visit) const;

 private:
  int Column(double x) const;
  int Row(double y) const;
  size_t Cell(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
  }

  bool IsOccupied(size_t cell) const { return ((occupied_[cell / 64] >> (cell % 64)) & 1u) != 0; }

  // REQUIRES: the cell is occupied.
  size_t NumberOf(size_t cell) const {
    assert(IsOccupied(cell));
    const uint64_t before = occupied_[cell / 64] & ((uint64_t{1} << (cell % 64)) - 1);
    return number_[cell / 64] + static_cast<size_t>(std::popcount(before));
  }

  // Calls visit(column, row, number) for the occupied cells, in the order of their numbers.
  template <typename Visit>
  void ForEachOccupied(Visit visit) const;

  // Calls visit(number, number) for all pairs of occupied cells that are equal or share a side or a
  // corner, once for each.
  template <typename Visit>
  void ForEachTwoCells(Visit visit) const;

  // Calls visit(column, row) for the cells along a segment, each once in a row.
  template <typename Visit>
  void ForEachCell(Point a, Point b, Visit visit) const;
  void Fill();

  // A segment in a cell.
  struct Entry {
    uint32_t segment = 0;
    uint32_t path = 0;
  };

  // The bounds of something, in single precision, with more slack than that loses.
  struct Box {
    float min_x = 0;
    float min_y = 0;
    float max_x = 0;
    float max_y = 0;

    void Include(const Box& box);

    // Along x or y: no more than the distance of the contents of both.
    float Gap(const Box& box) const;
  };

  // The entries of one path in one cell.
  struct Run {
    uint32_t path = 0;
    uint32_t begin = 0;
    uint32_t end = 0;
    Box box;
  };

  struct Runs {
    std::vector<Box> boxes;       // [entry] bounds of the part of the segment in the cell
    std::vector<Run> runs;        // by cell
    std::vector<uint32_t> first;  // [number of the cell] where its runs begin; one more at the end
  };

  Runs MakeRuns() const;
  Box BoxIn(const Segment& segment, int column, int row) const;

  template <typename Reach, typename Wanted, typename Visit>
  void VisitCells(const Runs& runs, size_t one, size_t other, Reach& reach, Wanted& wanted,
                  Visit& visit) const;
  template <typename Visit>
  void VisitRuns(const Runs& runs, const Run& one, const Run& other, float reach,
                 Visit& visit) const;

  std::vector<Segment> segments_;
  double cell_;
  double cells_per_mm_ = 1;
  double min_x_ = 0;
  double min_y_ = 0;
  int columns_ = 0;
  int rows_ = 0;

  // Most cells are empty; the others are numbered, row by row.
  std::vector<uint64_t> occupied_;  // bit cell % 64 of [cell / 64]
  std::vector<uint32_t> number_;    // [cell / 64] number of the first occupied one of these
  std::vector<uint32_t> first_;     // [number] where its entries begin; one more at the end
  std::vector<Entry> entries_;      // by cell, then segment
};

template <typename Visit>
void SegmentGrid::ForEachCell(Point a, Point b, Visit visit) const {
  const int end_column = Column(b.x);
  const int end_row = Row(b.y);
  int last_column = Column(a.x);
  int last_row = Row(a.y);
  visit(last_column, last_row);
  if (last_column == end_column && last_row == end_row) return;
  // Samples every quarter of a cell. A cell of which only a corner is touched may be missed, by
  // less than an eighth of its side.
  const int steps = static_cast<int>(Distance(a, b) * 4 * cells_per_mm_) + 1;
  // Along the line columns and rows change in one direction each. So if one of both changes by
  // one, or none does, there is nothing to see between two samples.
  constexpr int kStride = 3;
  const auto sample = [&](int i) {
    const double t = static_cast<double>(i) / steps;
    return std::pair(Column(a.x + (b.x - a.x) * t), Row(a.y + (b.y - a.y) * t));
  };
  const auto enter = [&](int column, int row) {
    if (column == last_column && row == last_row) return;
    last_column = column;
    last_row = row;
    visit(column, row);
  };
  for (int i = 0; i < steps; i += kStride) {
    const int end = std::min(i + kStride, steps);
    const auto [column, row] = sample(end);
    if (std::abs(column - last_column) + std::abs(row - last_row) > 1) {
      for (int between = i + 1; between < end; ++between) {
        const auto [c, r] = sample(between);
        enter(c, r);
      }
    }
    enter(column, row);
  }
}

inline void SegmentGrid::Box::Include(const Box& box) {
  min_x = std::min(min_x, box.min_x);
  min_y = std::min(min_y, box.min_y);
  max_x = std::max(max_x, box.max_x);
  max_y = std::max(max_y, box.max_y);
}

inline float SegmentGrid::Box::Gap(const Box& box) const {
  return std::max(std::max(min_x - box.max_x, box.min_x - max_x),
                  std::max(min_y - box.max_y, box.min_y - max_y));
}

template <typename Visit>
void SegmentGrid::VisitRuns(const Runs& runs, const Run& one, const Run& other, float reach,
                            Visit& visit) const {
  for (uint32_t i = one.begin; i < one.end; ++i) {
    if (runs.boxes[i].Gap(other.box) > reach) continue;
    for (uint32_t j = other.begin; j < other.end; ++j) {
      if (runs.boxes[i].Gap(runs.boxes[j]) > reach) continue;
      if (!visit(entries_[i].segment, entries_[j].segment)) return;
    }
  }
}

template <typename Reach, typename Wanted, typename Visit>
void SegmentGrid::VisitCells(const Runs& runs, size_t one, size_t other, Reach& reach,
                             Wanted& wanted, Visit& visit) const {
  const auto most = static_cast<float>(0.8 * cell_);  // more than anything reaches
  for (uint32_t i = runs.first[one]; i < runs.first[one + 1]; ++i) {
    const Run& a = runs.runs[i];
    for (uint32_t j = one == other ? i + 1 : runs.first[other]; j < runs.first[other + 1]; ++j) {
      const Run& b = runs.runs[j];
      const float gap = a.box.Gap(b.box);
      if (gap > most || a.path == b.path) continue;
      const auto near = static_cast<float>(reach(a.path, b.path));
      if (gap <= near && wanted(a.path, b.path)) VisitRuns(runs, a, b, near, visit);
    }
  }
}

template <typename Visit>
void SegmentGrid::ForEachTwoCells(Visit visit) const {
  ForEachOccupied([&](int column, int row, size_t number) {
    visit(number, number);
    const auto visit_with = [&](int other_column, int other_row) {
      if (other_column < 0 || other_column >= columns_ || other_row >= rows_) return;
      const size_t other = Cell(other_column, other_row);
      if (IsOccupied(other)) visit(number, NumberOf(other));
    };
    visit_with(column + 1, row);
    visit_with(column - 1, row + 1);
    visit_with(column, row + 1);
    visit_with(column + 1, row + 1);
  });
}

template <typename Reach, typename Wanted, typename Visit>
bool SegmentGrid::ForEachNearPair(Reach reach, Wanted wanted, Visit visit, double most) const {
  const Runs runs = MakeRuns();
  const auto paths_in = [&runs](size_t cell) {
    return static_cast<double>(runs.first[cell + 1] - runs.first[cell]);
  };
  double pairs = 0;
  ForEachTwoCells([&](size_t one, size_t other) { pairs += paths_in(one) * paths_in(other); });
  if (pairs > most) return false;
  ForEachTwoCells(
      [&](size_t one, size_t other) { VisitCells(runs, one, other, reach, wanted, visit); });
  return true;
}

template <typename Visit>
void SegmentGrid::ForEachOccupied(Visit visit) const {
  size_t number = 0;
  for (size_t word = 0; word < occupied_.size(); ++word) {
    for (uint64_t left = occupied_[word]; left != 0; left &= left - 1) {
      const size_t cell = word * 64 + static_cast<size_t>(std::countr_zero(left));
      visit(static_cast<int>(cell % static_cast<size_t>(columns_)),
            static_cast<int>(cell / static_cast<size_t>(columns_)), number++);
    }
  }
}

template <typename Visit>
void SegmentGrid::ForEachOnTravel(Point a, Point b, size_t& looks, Visit visit) const {
  if (columns_ == 0) return;
  bool going_on = looks > 0;
  ForEachCell(a, b, [&](int column, int row) {
    for (int r = row > 0 ? row - 1 : row; going_on && r <= row + 1 && r < rows_; ++r) {
      for (int c = column > 0 ? column - 1 : column; c <= column + 1 && c < columns_; ++c) {
        const size_t cell = Cell(c, r);
        if (!IsOccupied(cell)) continue;
        const size_t number = NumberOf(cell);
        for (uint32_t i = first_[number]; going_on && i < first_[number + 1]; ++i) {
          --looks;
          going_on = visit(entries_[i].segment) && looks > 0;
        }
      }
    }
  });
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_SEGMENT_GRID_H_
