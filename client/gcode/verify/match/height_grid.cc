#include "client/gcode/verify/match/height_grid.h"

#include <algorithm>
#include <cmath>

namespace traverse::gcode {
namespace {

constexpr double kUnitsPerMm = 100;
constexpr double kFarMm = 8000;
constexpr size_t kMostTiles = 4096;

// Rounding of heights, and how far a line rises above where its nozzle was.
constexpr int kLevelUnits = 5;

bool IsNear(Point p) { return std::abs(p.x) <= kFarMm && std::abs(p.y) <= kFarMm; }

int TileOf(int cell, int side) { return cell >= 0 ? cell / side : (cell + 1) / side - 1; }

size_t IndexIn(int x, int y, int side) {
  return static_cast<size_t>((y & (side - 1)) * side + (x & (side - 1)));
}

}  // namespace

HeightGrid::Height HeightGrid::Units(double mm) {
  return static_cast<Height>(std::clamp(std::round(mm * kUnitsPerMm), 0.0, kNever - 1.0));
}

double HeightGrid::highest_mm() const { return highest_ / kUnitsPerMm; }

// From where the piece begins, cell by cell: take(cell, from, to) gets the share of the piece
// where it enters the cell and leaves it.
template <typename Take>
void HeightGrid::ForEachCell(Point a, Point b, Take take) const {
  if (!IsNear(a) || !IsNear(b)) return;
  const double from[] = {a.x / cell_mm_, a.y / cell_mm_};
  const double delta[] = {b.x / cell_mm_ - from[0], b.y / cell_mm_ - from[1]};
  int at[2];
  int steps = 0;
  int step[2];
  double next[2];   // where the next border of the cell is crossed
  double every[2];  // and all further ones
  for (size_t axis = 0; axis < 2; ++axis) {
    at[axis] = static_cast<int>(std::floor(from[axis]));
    steps += std::abs(static_cast<int>(std::floor(from[axis] + delta[axis])) - at[axis]);
    step[axis] = delta[axis] < 0 ? -1 : 1;
    const double border = at[axis] + (delta[axis] < 0 ? 0 : 1);
    next[axis] = delta[axis] != 0 ? (border - from[axis]) / delta[axis] : 2;
    every[axis] = delta[axis] != 0 ? 1 / std::abs(delta[axis]) : 2;
  }
  double entered = 0;
  for (; steps >= 0; --steps) {
    const size_t axis = next[0] < next[1] ? 0 : 1;
    const double left = steps == 0 ? 1.0 : std::min(next[axis], 1.0);
    if (!take(Cell{at[0], at[1]}, entered, left)) return;
    entered = left;
    at[axis] += step[axis];
    next[axis] += every[axis];
  }
}

HeightGrid::Tile* HeightGrid::Find(int tile_x, int tile_y) {
  const std::pair key(tile_x, tile_y);
  if (key == last_key_) return last_;
  const auto found = tiles_.find(key);
  last_key_ = key;
  last_ = found != tiles_.end() ? found->second.get() : nullptr;
  return last_;
}

HeightGrid::Tile* HeightGrid::Make(Cell cell) {
  const int tile_x = TileOf(cell.x, kSide);
  const int tile_y = TileOf(cell.y, kSide);
  Tile* tile = Find(tile_x, tile_y);
  if (tile != nullptr || tiles_.size() >= kMostTiles) return tile;
  last_ = tiles_.emplace(last_key_, std::make_unique<Tile>()).first->second.get();
  return last_;
}

// What was visited in an earlier pass counts no more.
void HeightGrid::Renew(Tile& tile) const {
  if (tile.pass == pass_) return;
  tile.pass = pass_;
  tile.any_visit = false;
  tile.visited.fill(kNever);
  tile.clear.fill(kNever);
}

void HeightGrid::Print(Point a, Point b, double z_mm) {
  const Height z = Units(z_mm);
  highest_ = std::max(highest_, z);
  ForEachCell(a, b, [&](Cell cell, double, double) {
    Tile* tile = Make(cell);
    if (tile == nullptr) return true;
    Height& top = tile->top[IndexIn(cell.x, cell.y, kSide)];
    top = std::max(top, z);
    tile->highest = std::max(tile->highest, z);
    return true;
  });
}

void HeightGrid::Visit(Point a, double z_a_mm, Point b, double z_b_mm) {
  // Straight up or down it was at both ends.
  if (a.x == b.x && a.y == b.y) z_a_mm = z_b_mm = std::min(z_a_mm, z_b_mm);
  ForEachCell(a, b, [&](Cell cell, double from, double to) {
    Tile* tile = Make(cell);
    if (tile == nullptr) return true;
    Renew(*tile);
    tile->any_visit = true;
    const double rise = z_b_mm - z_a_mm;
    const Height z = Units(z_a_mm + rise * (rise > 0 ? to : from));
    const size_t index = IndexIn(cell.x, cell.y, kSide);
    tile->visited[index] = std::min(tile->visited[index], z);
    tile->clear[index] = std::min(tile->clear[index], z);
    return true;
  });
}

double HeightGrid::ReachOf(int excess) const {
  const double excess_mm = excess / kUnitsPerMm;
  if (excess <= kLevelUnits || excess_mm <= shape_.least_excess_mm) return 0;
  return std::min(shape_.base_mm + excess_mm, shape_.most_mm);
}

template <typename Wanted, typename Take>
void HeightGrid::ForEachAround(Cell center, double radius_mm, Wanted wanted, Take take) {
  const int r = static_cast<int>(radius_mm / cell_mm_);
  const double most = radius_mm * radius_mm / (cell_mm_ * cell_mm_) + 1e-9;
  for (int ty = TileOf(center.y - r, kSide); ty <= TileOf(center.y + r, kSide); ++ty) {
    for (int tx = TileOf(center.x - r, kSide); tx <= TileOf(center.x + r, kSide); ++tx) {
      Tile* tile = Find(tx, ty);
      if (tile == nullptr || !wanted(*tile)) continue;
      const int y_end = std::min(ty * kSide + kSide - 1, center.y + r);
      const int x_end = std::min(tx * kSide + kSide - 1, center.x + r);
      for (int y = std::max(ty * kSide, center.y - r); y <= y_end; ++y) {
        for (int x = std::max(tx * kSide, center.x - r); x <= x_end; ++x) {
          const double dx = x - center.x;
          const double dy = y - center.y;
          if (dx * dx + dy * dy > most) continue;
          if (!take(*tile, Cell{x, y}, IndexIn(x, y, kSide))) return;
        }
      }
    }
  }
}

// `cell` is that far from the head at `z`.
bool HeightGrid::WasAsNear(Cell cell, double off_mm, Height z) {
  const int low = z + kLevelUnits;
  bool was = false;
  ForEachAround(
      cell, off_mm > 0 || !shape_.is_tip ? off_mm + shape_.slack_mm : 0,
      [this](const Tile& tile) { return tile.pass == pass_ && tile.any_visit; },
      [&](const Tile& tile, Cell, size_t index) {
        was = tile.visited[index] <= low;
        return !was;
      });
  return was;
}

std::optional<HeightGrid::Hit> HeightGrid::HitAt(Cell cell, Height z) {
  std::optional<Hit> nearest;
  ForEachAround(
      cell, ReachOf(highest_ - z), [&](const Tile& tile) { return ReachOf(tile.highest - z) > 0; },
      [&](const Tile& tile, Cell other, size_t index) {
        const int excess = tile.top[index] - z;
        const double reach = ReachOf(excess);
        const double off = std::hypot(other.x - cell.x, other.y - cell.y) * cell_mm_;
        if (reach <= 0 || off > reach || (nearest && off >= nearest->off_mm)) return true;
        if (WasAsNear(other, off, z)) return true;
        const Point at{(other.x + 0.5) * cell_mm_, (other.y + 0.5) * cell_mm_};
        nearest = Hit{at, excess / kUnitsPerMm, off};
        return off > 0;
      });
  return nearest;
}

std::optional<HeightGrid::Hit> HeightGrid::NearestHit(Point a, double z_a_mm, Point b,
                                                      double z_b_mm) {
  std::optional<Hit> nearest;
  if (ReachOf(highest_ - Units(std::min(z_a_mm, z_b_mm))) <= 0) return nearest;
  if (a.x == b.x && a.y == b.y) z_a_mm = z_b_mm = std::min(z_a_mm, z_b_mm);
  ForEachCell(a, b, [&](Cell cell, double from, double to) {
    const double rise = z_b_mm - z_a_mm;
    const Height z = Units(z_a_mm + rise * (rise > 0 ? from : to));
    Tile* tile = Make(cell);
    if (tile == nullptr) return true;
    Renew(*tile);
    const size_t index = IndexIn(cell.x, cell.y, kSide);
    if (tile->clear[index] <= z) return true;
    const std::optional<Hit> hit = HitAt(cell, z);
    if (!hit) {
      tile->clear[index] = z;
    } else if (!nearest || hit->off_mm < nearest->off_mm) {
      nearest = hit;
    }
    return !nearest || nearest->off_mm > 0;
  });
  return nearest;
}

}  // namespace traverse::gcode
