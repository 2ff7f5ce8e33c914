#include "client/gcode/model/wall_crowd.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace traverse::gcode {
namespace {

constexpr double kMostColumns = 64;
constexpr double kLeastCellMm = 1;

// A piece counts as this long at least: what is looked at are segments, however short.
constexpr double kLeastPieceMm = 0.1;

}  // namespace

WallCrowd::WallCrowd(Point low, Point high)
    : low_(low),
      cell_mm_(std::max(
          {kLeastCellMm, (high.x - low.x) / kMostColumns, (high.y - low.y) / kMostColumns})),
      columns_(static_cast<size_t>((high.x - low.x) / cell_mm_) + 1),
      rows_(static_cast<size_t>((high.y - low.y) / cell_mm_) + 1),
      length_mm_(columns_ * rows_, 0) {
  assert(low.x <= high.x && low.y <= high.y);
}

template <typename Visit>
void WallCrowd::ForEachPiece(const std::vector<Point>& line, Visit visit) const {
  const auto index = [this](double mm, size_t count) {
    return static_cast<size_t>(std::clamp(mm / cell_mm_, 0.0, static_cast<double>(count - 1)));
  };
  for (size_t i = 1; i < line.size(); ++i) {
    const Point a = line[i - 1];
    const Point b = line[i];
    const double length = Distance(a, b);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length / cell_mm_)));
    for (int k = 0; k < pieces; ++k) {
      const double t = (k + 0.5) / pieces;
      const size_t column = index(a.x + (b.x - a.x) * t - low_.x, columns_);
      const size_t row = index(a.y + (b.y - a.y) * t - low_.y, rows_);
      visit(row * columns_ + column, std::max(length / pieces, kLeastPieceMm));
    }
  }
}

bool WallCrowd::Takes(const std::vector<Point>& line) {
  const auto most = static_cast<float>(kMostMmPerSquareMm * cell_mm_ * cell_mm_);
  std::vector<std::pair<size_t, float>> added;
  bool takes = true;
  ForEachPiece(line, [&](size_t cell, double length_mm) {
    takes = takes && length_mm_[cell] < most;
    if (!takes) return;
    added.emplace_back(cell, length_mm_[cell]);
    length_mm_[cell] += static_cast<float>(length_mm);
  });
  if (takes) return true;
  for (auto was = added.rbegin(); was != added.rend(); ++was) length_mm_[was->first] = was->second;
  return false;
}

}  // namespace traverse::gcode
