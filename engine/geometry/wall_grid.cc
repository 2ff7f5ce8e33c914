#include "engine/geometry/wall_grid.h"

namespace traverse {
namespace {

// This share at each end of a way that is shorter than its slack is not examined.
constexpr double kMostEnd = 0.2;

// Most cells per segment, and most cells of any grid.
constexpr double kCellsPerSegment = 4;
constexpr double kLeastCells = 64;

}  // namespace

WallGrid::WallGrid(absl::Span<const Wall> walls, double slack_mm, Budget* budget)
    : slack_mm_(slack_mm) {
  Rest rest(budget);
  size_t points = 0;
  for (const Wall& wall : walls) points += wall.points.size() + 1;
  segments_.reserve(points);
  first_of_wall_.reserve(walls.size() + 1);
  for (size_t w = 0; w < walls.size(); ++w) {
    first_of_wall_.push_back(static_cast<uint32_t>(segments_.size()));
    const std::vector<Point>& line = walls[w].points;
    const auto add = [&](Point a, Point b) {
      rest();
      if (a == b) return;
      segments_.push_back({a, b, static_cast<uint32_t>(w)});
      box_.Add(a);
      box_.Add(b);
    };
    for (size_t i = 0; i + 1 < line.size(); ++i) add(line[i], line[i + 1]);
    if (walls[w].closed) add(line.back(), line.front());
  }
  first_of_wall_.push_back(static_cast<uint32_t>(segments_.size()));
  if (segments_.empty()) return;
  SizeCells(rest);
  Fill(rest);
}

// A segment as long as a cell is in three of them at most, and longer ones are few.
void WallGrid::SizeCells(Rest& rest) {
  const double n = static_cast<double>(segments_.size());
  double length_mm = 0;
  for (const WallSegment& segment : segments_) {
    rest();
    length_mm += Distance(segment.a, segment.b);
  }
  const double most = kCellsPerSegment * n + kLeastCells;
  const double width = box_.width();
  const double height = box_.height();
  cell_mm_ = std::max({length_mm / n, std::sqrt(width * height / most), 1e-3});
  while ((std::floor(width / cell_mm_) + 1) * (std::floor(height / cell_mm_) + 1) > most) {
    cell_mm_ *= 1.5;
  }
  low_ = box_.low();
  per_mm_ = 1 / cell_mm_;
  columns_ = static_cast<int>(width * per_mm_) + 1;
  rows_ = static_cast<int>(height * per_mm_) + 1;
}

// Counting sort: how many entries a cell has, then where they begin, then the entries.
void WallGrid::Fill(Rest& rest) {
  const auto for_each_cell = [&](const WallSegment& segment, const auto& visit) {
    ForEachRow(segment.a, segment.b, 0, [&](int row, int first, int last) {
      rest(static_cast<size_t>(last - first) + 1);
      const size_t cell = static_cast<size_t>(row) * static_cast<size_t>(columns_);
      for (int column = first; column <= last; ++column) {
        visit(cell + static_cast<size_t>(column));
      }
      return true;
    });
  };
  first_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_) + 2, 0);
  for (const WallSegment& segment : segments_) {
    for_each_cell(segment, [this](size_t cell) { ++first_[cell + 2]; });
  }
  for (size_t cell = 2; cell < first_.size(); ++cell) {
    rest();
    first_[cell] += first_[cell - 1];
  }
  entries_.resize(first_.back());
  for (uint32_t s = 0; s < segments_.size(); ++s) {
    for_each_cell(segments_[s], [&](size_t cell) { entries_[first_[cell + 1]++] = s; });
  }
  first_.pop_back();
}

std::pair<Point, Point> WallGrid::WithoutEnds(Point a, Point b, MoveEnds ends) const {
  const double length = Distance(a, b);
  if (!(length > 0)) return {a, b};
  const double cut = std::min(slack_mm_ / length, kMostEnd);
  const Point off{(b.x - a.x) * cut, (b.y - a.y) * cut};
  return {ends.a ? Point{a.x + off.x, a.y + off.y} : a,
          ends.b ? Point{b.x - off.x, b.y - off.y} : b};
}

bool WallGrid::Crosses(Point a, Point b, MoveEnds ends) const {
  if (std::pair(b.x, b.y) < std::pair(a.x, a.y)) {
    std::swap(a, b);
    std::swap(ends.a, ends.b);
  }
  const auto [from, to] = WithoutEnds(a, b, ends);
  bool crosses = false;
  ForEachOnLine(from, to, [&, from = from, to = to](uint32_t s) {
    crosses = SegmentsCross(from, to, segments_[s].a, segments_[s].b);
    return !crosses;
  });
  return crosses;
}

}  // namespace traverse
