#include "client/gcode/plan/room_map.h"

#include <algorithm>
#include <cmath>

namespace traverse::gcode {
namespace {

constexpr double kUnitsPerMm = 100;
constexpr RoomHeight kNever = UINT16_MAX;

// What rises no more than this above the tip touches nothing: heights are rounded.
constexpr RoomHeight kLevel = 5;

// A move may be lower by so much, of rounding.
constexpr RoomHeight kSlack = 2;

constexpr double kMostCells = 1 << 20;
constexpr double kMostInARow = 1 << 12;

// Calls take(column, row, z_mm) for each cell of the box that a straight move passes, one after the
// other, with the lowest height that it has there; ends where that returns false. So a move passes
// the same cells whenever it is asked about.
template <typename Take>
void ForEachCell(const RoomBox& box, Point a, double z_a_mm, Point b, double z_b_mm, Take take) {
  // Straight down it is at both ends.
  if (a == b) z_a_mm = z_b_mm = std::min(z_a_mm, z_b_mm);
  const double from[] = {(a.x - box.low.x) / box.cell_mm, (a.y - box.low.y) / box.cell_mm};
  const double delta[] = {(b.x - a.x) / box.cell_mm, (b.y - a.y) / box.cell_mm};
  const int size[] = {box.columns, box.rows};
  double begin = 0;  // shares of the move
  double end = 1;
  int at[] = {0, 0};
  for (size_t axis = 0; axis < 2; ++axis) {
    if (delta[axis] == 0) {
      if (from[axis] < 0 || from[axis] >= size[axis]) return;
      continue;
    }
    const double at_low = -from[axis] / delta[axis];
    const double at_high = (size[axis] - from[axis]) / delta[axis];
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  }
  if (!(begin <= end)) return;
  for (size_t axis = 0; axis < 2; ++axis) {
    const double entered = std::floor(from[axis] + delta[axis] * begin);
    at[axis] = static_cast<int>(std::clamp(entered, 0.0, size[axis] - 1.0));
  }
  const double rise = z_b_mm - z_a_mm;
  // The share at which the cell is left along that axis.
  const auto left_at = [&](size_t axis) {
    if (delta[axis] == 0) return 2.0;
    return (at[axis] + (delta[axis] > 0 ? 1 : 0) - from[axis]) / delta[axis];
  };
  while (true) {
    const double next[] = {left_at(0), left_at(1)};
    const size_t axis = next[0] < next[1] ? 0 : 1;
    const double leave = std::min(next[axis], end);
    if (!take(at[0], at[1], z_a_mm + rise * (rise > 0 ? begin : leave)) || leave >= end) return;
    at[axis] += delta[axis] > 0 ? 1 : -1;
    if (at[axis] < 0 || at[axis] >= size[axis]) return;
    begin = leave;
  }
}

}  // namespace

RoomHeight InRoomHeight(double mm) {
  return static_cast<RoomHeight>(std::clamp(std::round(mm * kUnitsPerMm), 0.0, kNever - 1.0));
}

RoomHeight RoomMap::At(int column, int row) const {
  const auto found =
      tiles_.find(static_cast<uint32_t>(column / kSide) << 16 | static_cast<uint32_t>(row / kSide));
  if (found == tiles_.end()) return 0;
  return found->second[static_cast<size_t>(row % kSide * kSide + column % kSide)];
}

bool RoomMap::IsClear(Point a, double z_a_mm, Point b, double z_b_mm) const {
  if (InRoomHeight(std::min(z_a_mm, z_b_mm)) + kSlack >= highest_) return true;
  bool clear = true;
  ForEachCell(box_, a, z_a_mm, b, z_b_mm, [&](int column, int row, double z_mm) {
    clear = InRoomHeight(z_mm) + kSlack >= At(column, row);
    return clear;
  });
  return clear;
}

void RoomBuilder::Window::Add(int column, int row) {
  column_begin = std::min(column_begin, column);
  row_begin = std::min(row_begin, row);
  column_end = std::max(column_end, column + 1);
  row_end = std::max(row_end, row + 1);
}

RoomBuilder::RoomBuilder(const BoundingBox& bounds, const HeadPart& part) : part_(part) {
  const double width = bounds.width() + 2 * part.cell_mm;
  const double depth = bounds.height() + 2 * part.cell_mm;
  part_.cell_mm = std::max({part.cell_mm, std::sqrt(width * depth / kMostCells),
                            width / kMostInARow, depth / kMostInARow});
  const double cell = part_.cell_mm;
  box_.cell_mm = cell;
  const Point low = bounds.low();
  const Point high = bounds.high();
  box_.low = {std::floor(low.x / cell) * cell, std::floor(low.y / cell) * cell};
  box_.columns = static_cast<int>((high.x - box_.low.x) / cell) + 1;
  box_.rows = static_cast<int>((high.y - box_.low.y) / cell) + 1;
  reach_ = static_cast<int>((part.most_mm + part.slack_mm) / cell);
  for (int row = -reach_; row <= reach_; ++row) {
    for (int column = -reach_; column <= reach_; ++column) {
      const double cells = std::hypot(row, column);
      const double off = cells * cell;
      const double least = std::max(part.least_excess_mm, off - part.base_mm);
      const bool may_touch = off <= part.most_mm;
      offsets_.push_back(
          {column, row, cells, may_touch ? std::max(InRoomHeight(least), kLevel) : kNever});
    }
  }
  std::ranges::stable_sort(offsets_, {}, &Offset::cells);
  const auto cells = static_cast<size_t>(box_.columns) * static_cast<size_t>(box_.rows);
  top_.assign(cells, 0);
  now_.assign(cells, 0);
  lowest_.assign(cells, kNever);
  need_.assign(cells, 0);
}

void RoomBuilder::Print(Point a, Point b, double z_mm) {
  const RoomHeight z = InRoomHeight(z_mm);
  ForEachCell(box_, a, z_mm, b, z_mm, [&](int column, int row, double) {
    RoomHeight& top = now_[Index(column, row)];
    top = std::max(top, z);
    printed_.Add(column, row);
    return true;
  });
}

void RoomBuilder::Visit(Point a, double z_a_mm, Point b, double z_b_mm) {
  pass_low_ = std::min(pass_low_, InRoomHeight(std::min(z_a_mm, z_b_mm)));
  ForEachCell(box_, a, z_a_mm, b, z_b_mm, [&](int column, int row, double z_mm) {
    RoomHeight& lowest = lowest_[Index(column, row)];
    lowest = std::min(lowest, InRoomHeight(z_mm));
    visited_.Add(column, row);
    return true;
  });
}

// Of the head, in the pass.
RoomHeight RoomBuilder::LowestAt(int column, int row) const {
  return visited_.Has(column, row) ? lowest_[Index(column, row)] : kNever;
}

// Around the cell the head has to be so high, unless it was as near to it, as low.
void RoomBuilder::Spread(int column, int row, int64_t& steps) {
  const RoomHeight top = top_[Index(column, row)];
  const double slack = part_.slack_mm / part_.cell_mm;
  RoomHeight lowest = kNever;  // as near, of offsets before `seen`
  size_t seen = 0;
  for (const Offset& offset : offsets_) {
    --steps;
    for (; seen < offsets_.size() && offsets_[seen].cells <= offset.cells + slack; ++seen) {
      const Offset& near = offsets_[seen];
      lowest = std::min(lowest, LowestAt(column + near.column, row + near.row));
    }
    if (lowest <= pass_low_ || top <= offset.least) return;
    const int x = column + offset.column;
    const int y = row + offset.row;
    if (!visited_.Has(x, y)) continue;
    RoomHeight& need = need_[Index(x, y)];
    need = std::max(need, std::min<RoomHeight>(top - offset.least, lowest));
  }
}

void RoomBuilder::Gather(RoomMap& map) const {
  for (int row = visited_.row_begin; row < visited_.row_end; ++row) {
    for (int column = visited_.column_begin; column < visited_.column_end; ++column) {
      const size_t index = Index(column, row);
      const RoomHeight need = std::min(need_[index], lowest_[index]);
      if (need <= pass_low_) continue;
      constexpr int kSide = RoomMap::kSide;
      RoomMap::Tile& tile = map.tiles_[static_cast<uint32_t>(column / kSide) << 16 |
                                       static_cast<uint32_t>(row / kSide)];
      tile[static_cast<size_t>(row % kSide * kSide + column % kSide)] = need;
      map.highest_ = std::max(map.highest_, need);
    }
  }
}

// What was printed stands, and the next pass begins.
void RoomBuilder::Forget() {
  for (int row = printed_.row_begin; row < printed_.row_end; ++row) {
    for (size_t i = Index(printed_.column_begin, row); i < Index(printed_.column_end, row); ++i) {
      top_[i] = std::max(top_[i], now_[i]);
      highest_ = std::max(highest_, now_[i]);
      now_[i] = 0;
    }
  }
  for (int row = visited_.row_begin; row < visited_.row_end; ++row) {
    for (size_t i = Index(visited_.column_begin, row); i < Index(visited_.column_end, row); ++i) {
      lowest_[i] = kNever;
      need_[i] = 0;
    }
  }
  printed_ = visited_ = {};
  pass_low_ = kNever;
}

RoomMap RoomBuilder::EndPass(int64_t& steps) {
  RoomMap map;
  map.box_ = box_;
  const RoomHeight least = std::max(InRoomHeight(part_.least_excess_mm), kLevel);
  if (!visited_.empty() && highest_ > pass_low_ + least) {
    const int row_end = std::min(visited_.row_end + reach_, box_.rows);
    const int column_end = std::min(visited_.column_end + reach_, box_.columns);
    for (int row = std::max(visited_.row_begin - reach_, 0); row < row_end && steps > 0; ++row) {
      for (int column = std::max(visited_.column_begin - reach_, 0); column < column_end;
           ++column) {
        if (top_[Index(column, row)] > pass_low_ + least) Spread(column, row, steps);
      }
    }
    if (steps > 0) Gather(map);
  }
  Forget();
  return map;
}

}  // namespace traverse::gcode
