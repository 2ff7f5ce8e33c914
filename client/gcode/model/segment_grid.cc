#include "client/gcode/model/segment_grid.h"

#include <algorithm>

#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {
namespace {

double Turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double SquaredToPoint(const Segment& s, Point p) {
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

bool Cross(Point a, Point b, Point c, Point d) {
  return Turn(a, b, c) * Turn(a, b, d) < 0 && Turn(c, d, a) * Turn(c, d, b) < 0;
}

double SquaredDistance(const Segment& s, const Segment& t) {
  if (Cross(s.a, s.b, t.a, t.b)) return 0;
  return std::min({SquaredToPoint(s, t.a), SquaredToPoint(s, t.b), SquaredToPoint(t, s.a),
                   SquaredToPoint(t, s.b)});
}

void AddSegments(const std::vector<Point>& line, uint32_t path, std::vector<Segment>& segments) {
  for (size_t k = 0; k + 1 < line.size(); ++k) segments.push_back({line[k], line[k + 1], path});
}

SegmentGrid::SegmentGrid(std::vector<Segment> segments, double cell_mm)
    : segments_(std::move(segments)), cell_(cell_mm) {
  if (segments_.empty()) return;
  BoundingBox box;
  double length = 0;
  for (const Segment& s : segments_) {
    length += Distance(s.a, s.b);
    box.Add(s.a);
    box.Add(s.b);
  }
  min_x_ = box.low().x;
  min_y_ = box.low().y;
  const double width = box.width();
  const double height = box.height();
  const size_t most_entries = kCellsPerSegment * (segments_.size() + 16);
  const auto most_cells = static_cast<double>(std::min(kMaxCells, most_entries));
  // More than a kilometer in one layer is none of a print.
  constexpr double kMostLengthOfEach = 16;
  const double most_length = kMostLengthOfEach * static_cast<double>(segments_.size()) + (1 << 20);
  while ((width / cell_ + 1) * (height / cell_ + 1) > most_cells ||
         length / cell_ > std::min(static_cast<double>(most_entries), most_length)) {
    cell_ *= 2;
  }
  cells_per_mm_ = 1 / cell_;
  columns_ = static_cast<int>(width / cell_) + 1;
  rows_ = static_cast<int>(height / cell_) + 1;
  Fill();
}

int SegmentGrid::Column(double x) const {
  return std::clamp(static_cast<int>((x - min_x_) * cells_per_mm_), 0, columns_ - 1);
}

int SegmentGrid::Row(double y) const {
  return std::clamp(static_cast<int>((y - min_y_) * cells_per_mm_), 0, rows_ - 1);
}

void SegmentGrid::Fill() {
  struct Occupancy {
    uint32_t cell = 0;
    uint32_t segment = 0;
  };
  std::vector<Occupancy> occupancies;
  occupancies.reserve(segments_.size() * 2);
  occupied_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_) / 64 + 1, 0);
  for (size_t s = 0; s < segments_.size(); ++s) {
    ForEachCell(segments_[s].a, segments_[s].b, [&, this](int column, int row) {
      const size_t cell = Cell(column, row);
      occupied_[cell / 64] |= uint64_t{1} << (cell % 64);
      occupancies.push_back({static_cast<uint32_t>(cell), static_cast<uint32_t>(s)});
    });
  }
  uint32_t count = 0;
  number_.reserve(occupied_.size());
  for (const uint64_t word : occupied_) {
    number_.push_back(count);
    count += static_cast<uint32_t>(std::popcount(word));
  }
  // Counting sort: the number of entries per cell, then where they begin, then the entries.
  first_.assign(count + size_t{1}, 0);
  for (Occupancy& it : occupancies) {
    it.cell = static_cast<uint32_t>(NumberOf(it.cell));
    ++first_[it.cell + 1];
  }
  for (size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  entries_.resize(occupancies.size());
  std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Occupancy& it : occupancies) {
    entries_[next[it.cell]++] = {it.segment, segments_[it.segment].path};
  }
}

// Where segments come near each other they are within an eighth of a cell of one that they are in.
SegmentGrid::Box SegmentGrid::BoxIn(const Segment& segment, int column, int row) const {
  constexpr double kSlackMm = 1e-3;
  const double slack = cell_ / 4;
  const double left = min_x_ + column * cell_ - slack;
  const double below = min_y_ + row * cell_ - slack;
  const auto [x0, x1] = std::minmax(segment.a.x, segment.b.x);
  const auto [y0, y1] = std::minmax(segment.a.y, segment.b.y);
  return {static_cast<float>(std::max(x0, left) - min_x_ - kSlackMm),
          static_cast<float>(std::max(y0, below) - min_y_ - kSlackMm),
          static_cast<float>(std::min(x1, left + cell_ + 2 * slack) - min_x_ + kSlackMm),
          static_cast<float>(std::min(y1, below + cell_ + 2 * slack) - min_y_ + kSlackMm)};
}

SegmentGrid::Runs SegmentGrid::MakeRuns() const {
  Runs runs;
  runs.boxes.resize(entries_.size());
  runs.runs.reserve(entries_.size() / 2);
  runs.first.assign(first_.size(), 0);
  ForEachOccupied([&](int column, int row, size_t number) {
    for (uint32_t i = first_[number]; i < first_[number + 1]; ++i) {
      runs.boxes[i] = BoxIn(segments_[entries_[i].segment], column, row);
      if (i > first_[number] && entries_[i].path == entries_[i - 1].path) {
        ++runs.runs.back().end;
        runs.runs.back().box.Include(runs.boxes[i]);
      } else {
        runs.runs.push_back({entries_[i].path, i, i + 1, runs.boxes[i]});
      }
    }
    runs.first[number + 1] = static_cast<uint32_t>(runs.runs.size());
  });
  return runs;
}

}  // namespace traverse::gcode
