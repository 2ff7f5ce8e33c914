#include "client/gcode/segment_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traverse::gcode {
namespace {

double Turn(Vertex a, Vertex b, Vertex c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double SquaredToPoint(const Segment& s, Vertex p) {
  const double dx = s.b.x - s.a.x;
  const double dy = s.b.y - s.a.y;
  const double length2 = dx * dx + dy * dy;
  double t = 0;
  if (length2 > 0) {
    t = std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / length2, 0.0, 1.0);
  }
  const double ex = s.a.x + t * dx - p.x;
  const double ey = s.a.y + t * dy - p.y;
  return ex * ex + ey * ey;
}

}  // namespace

bool Cross(Vertex a, Vertex b, Vertex c, Vertex d) {
  return Turn(a, b, c) * Turn(a, b, d) < 0 && Turn(c, d, a) * Turn(c, d, b) < 0;
}

double SquaredDistance(const Segment& s, const Segment& t) {
  if (Cross(s.a, s.b, t.a, t.b)) return 0;
  return std::min({SquaredToPoint(s, t.a), SquaredToPoint(s, t.b), SquaredToPoint(t, s.a),
                   SquaredToPoint(t, s.b)});
}

SegmentGrid::SegmentGrid(std::vector<Segment> segments) : segments_(std::move(segments)) {
  if (segments_.empty()) return;
  double max_x = -std::numeric_limits<double>::max();
  double max_y = max_x;
  min_x_ = min_y_ = -max_x;
  for (const Segment& s : segments_) {
    min_x_ = std::min({min_x_, s.a.x, s.b.x});
    min_y_ = std::min({min_y_, s.a.y, s.b.y});
    max_x = std::max({max_x, s.a.x, s.b.x});
    max_y = std::max({max_y, s.a.y, s.b.y});
  }
  const double width = max_x - min_x_;
  const double height = max_y - min_y_;
  const size_t most = std::min(kMaxCells, kCellsPerSegment * (segments_.size() + 16));
  while ((width / cell_ + 1) * (height / cell_ + 1) > static_cast<double>(most)) cell_ *= 2;
  columns_ = static_cast<int>(width / cell_) + 1;
  rows_ = static_cast<int>(height / cell_) + 1;
  Fill();
}

int SegmentGrid::Column(double x) const {
  return std::clamp(static_cast<int>((x - min_x_) / cell_), 0, columns_ - 1);
}

int SegmentGrid::Row(double y) const {
  return std::clamp(static_cast<int>((y - min_y_) / cell_), 0, rows_ - 1);
}

void SegmentGrid::Fill() {
  // Counting sort: how many entries a cell has, then where they begin, then the entries.
  first_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_) + 1, 0);
  for (const Segment& s : segments_) {
    ForEachCell(s.a, s.b, [this](int column, int row) { ++first_[Cell(column, row) + 1]; });
  }
  for (size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  entries_.resize(first_.back());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (size_t s = 0; s < segments_.size(); ++s) {
    ForEachCell(segments_[s].a, segments_[s].b, [&](int column, int row) {
      entries_[next[Cell(column, row)]++] = static_cast<uint32_t>(s);
    });
  }
}

}  // namespace traverse::gcode
