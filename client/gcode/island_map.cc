#include "client/gcode/island_map.h"

#include <cmath>

#include "absl/container/flat_hash_map.h"
#include "absl/types/span.h"

namespace traverse::gcode {
namespace {

constexpr double kPointsApartMm = 0.5;

// Points of one island that follow each other closer than this are as good as one.
constexpr double kSamePointMm = 0.25;

// Pairs of points that are looked at in a layer.
constexpr uint64_t kMostPairs = 4'000'000;

// Narrows the shares of a line between which it lies on the plate, along one axis.
void Narrow(double from, double length, double& begin, double& end) {
  if (length == 0) {
    if (std::abs(from) > kFarthestMm) end = -1;
    return;
  }
  const double low = (-kFarthestMm - from) / length;
  const double high = (kFarthestMm - from) / length;
  begin = std::max(begin, std::min(low, high));
  end = std::min(end, std::max(low, high));
}

// The cell of `size` mm at a point, in mm.
uint64_t CellOf(double x, double y, double size) {
  const auto index = [size](double value) {
    return static_cast<uint32_t>(static_cast<int32_t>(std::floor(value / size)));
  };
  return uint64_t{index(x)} << 32 | index(y);
}

uint64_t Beside(uint64_t cell, uint32_t columns, uint32_t rows) {
  const auto column = static_cast<uint32_t>(cell >> 32) + columns;
  return uint64_t{column} << 32 | (static_cast<uint32_t>(cell) + rows);
}

}  // namespace

void IslandMap::AddLine(double from_x, double from_y, double to_x, double to_y, uint32_t island) {
  double dx = to_x - from_x;
  double dy = to_y - from_y;
  double begin = 0;
  double end = 1;
  Narrow(from_x, dx, begin, end);
  Narrow(from_y, dy, begin, end);
  if (!(begin <= end)) return;
  from_x += dx * begin;
  from_y += dy * begin;
  dx *= end - begin;
  dy *= end - begin;
  const double steps = std::max(std::ceil(std::hypot(dx, dy) / kPointsApartMm), 1.0);
  looked_at_ += steps;
  full_ = full_ || looked_at_ > kMostPointsOfLayer;
  for (double step = 0; step <= steps && !full_; ++step) {
    const double x = from_x + dx * step / steps;
    const double y = from_y + dy * step / steps;
    Add({x, y, island, CellOf(x, y, IslandTree::kMostMm)});
  }
}

void IslandMap::Add(const PrintedPoint& point) {
  if (count_ > 1 && points_.size() < kMostCellsOfLayer) {
    const bool same =
        !points_.empty() && points_.back().island == point.island &&
        std::hypot(points_.back().x - point.x, points_.back().y - point.y) < kSamePointMm;
    if (!same) points_.push_back(point);
  }
  const IslandCell cell{CellOf(point.x, point.y, 1), point.island};
  if (!cells_.empty() && cells_.back() == cell) return;
  cells_.push_back(cell);
  if (cells_.size() < room_) return;
  Tidy();
  full_ = cells_.size() >= kMostCellsOfLayer;
  room_ = 2 * cells_.size() + kLeastRoom;
}

void IslandMap::Tidy() {
  std::sort(cells_.begin(), cells_.end());
  cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
}

std::vector<IslandCell> IslandMap::TakeCells() {
  Tidy();
  return std::move(cells_);
}

IslandTree IslandMap::TakeTree() {
  std::vector<PrintedPoint> points = std::exchange(points_, {});
  std::ranges::stable_sort(points, {}, &PrintedPoint::cell);
  return {count_, GapsOf(points)};
}

// `points` by cell.
std::vector<IslandGap> IslandMap::GapsOf(const std::vector<PrintedPoint>& points) {
  absl::flat_hash_map<uint64_t, absl::Span<const PrintedPoint>> cells;
  for (size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    while (end < points.size() && points[end].cell == points[begin].cell) ++end;
    cells[points[begin].cell] = absl::MakeConstSpan(points).subspan(begin, end - begin);
  }
  uint64_t left = kMostPairs;
  absl::flat_hash_map<std::pair<uint32_t, uint32_t>, double> squares;
  const auto look_at = [&](const PrintedPoint& a, const PrintedPoint& b) {
    const double square = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
    if (a.island == b.island || square > IslandTree::kMostMm * IslandTree::kMostMm) return;
    const auto [at, is_new] = squares.try_emplace(std::minmax(a.island, b.island), square);
    if (!is_new) at->second = std::min(at->second, square);
  };
  const auto of_one = [](absl::Span<const PrintedPoint> some, uint32_t island) {
    return std::all_of(some.begin(), some.end(),
                       [island](const PrintedPoint& point) { return point.island == island; });
  };
  for (const auto& [cell, here] : cells) {
    // Each cell with itself, and with half of those around it.
    for (const uint64_t other : {cell, Beside(cell, 0, 1), Beside(cell, 1, UINT32_MAX),
                                 Beside(cell, 1, 0), Beside(cell, 1, 1)}) {
      const auto there = cells.find(other);
      if (there == cells.end()) continue;
      const uint32_t island = here[0].island;
      if (of_one(here, island) && of_one(there->second, island)) continue;
      const uint64_t pairs = here.size() * there->second.size();
      if (pairs > left) return {};
      left -= pairs;
      for (const PrintedPoint& a : here) {
        for (const PrintedPoint& b : there->second) look_at(a, b);
      }
    }
  }
  std::vector<IslandGap> gaps;
  gaps.reserve(squares.size());
  for (const auto& [pair, square] : squares) {
    gaps.push_back({pair.first, pair.second, std::sqrt(square)});
  }
  return gaps;
}

}  // namespace traverse::gcode
