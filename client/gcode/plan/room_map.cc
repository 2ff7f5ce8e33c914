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
  if (empty() || InRoomHeight(std::min(z_a_mm, z_b_mm)) + kSlack >= highest_) return true;
  // Straight down it is at both ends.
  if (a == b) z_a_mm = z_b_mm = std::min(z_a_mm, z_b_mm);
  const double pieces = std::min(std::ceil(Distance(a, b) * 3 / cell_mm_), 3 * kMostCells);
  for (double i = 0; i <= pieces; ++i) {
    const double share = pieces > 0 ? i / pieces : 0;
    const double x = (a.x + (b.x - a.x) * share - low_.x) / cell_mm_;
    const double y = (a.y + (b.y - a.y) * share - low_.y) / cell_mm_;
    if (!(x >= 0 && y >= 0 && x < kMostInARow && y < kMostInARow)) continue;
    const double z = z_a_mm + (z_b_mm - z_a_mm) * share;
    if (InRoomHeight(z) + kSlack < At(static_cast<int>(x), static_cast<int>(y))) return false;
  }
  return true;
}

void RoomBuilder::Window::Add(int column, int row) {
  column_begin = std::min(column_begin, column);
  row_begin = std::min(row_begin, row);
  column_end = std::max(column_end, column + 1);
  row_end = std::max(row_end, row + 1);
}

RoomBuilder::RoomBuilder(Point low, Point high, const HeadPart& part) : part_(part) {
  const double width = std::max(high.x - low.x, 0.0) + 2 * part.cell_mm;
  const double depth = std::max(high.y - low.y, 0.0) + 2 * part.cell_mm;
  part_.cell_mm = std::max({part.cell_mm, std::sqrt(width * depth / kMostCells),
                            width / kMostInARow, depth / kMostInARow});
  const double cell = part_.cell_mm;
  low_ = {std::floor(low.x / cell) * cell, std::floor(low.y / cell) * cell};
  columns_ = static_cast<int>((high.x - low_.x) / cell) + 1;
  rows_ = static_cast<int>((high.y - low_.y) / cell) + 1;
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
  std::stable_sort(offsets_.begin(), offsets_.end(),
                   [](const Offset& a, const Offset& b) { return a.cells < b.cells; });
  const auto cells = static_cast<size_t>(columns_) * static_cast<size_t>(rows_);
  top_.assign(cells, 0);
  now_.assign(cells, 0);
  lowest_.assign(cells, kNever);
  need_.assign(cells, 0);
}

// take(column, row, share) for points on the piece, as near to each other as cells are wide, or
// nearer. What is outside of the box is left out.
template <typename Take>
void RoomBuilder::ForEachCell(Point a, Point b, Take take) const {
  const double cell = part_.cell_mm;
  double begin = 0;
  double end = 1;
  const auto clip = [&](double from, double delta, double size) {
    if (delta == 0) {
      if (from < 0 || from >= size) end = -1;
      return;
    }
    const double at_low = -from / delta;
    const double at_high = (size - from) / delta;
    begin = std::max(begin, std::min(at_low, at_high));
    end = std::min(end, std::max(at_low, at_high));
  };
  const double x = (a.x - low_.x) / cell;
  const double y = (a.y - low_.y) / cell;
  const double dx = (b.x - a.x) / cell;
  const double dy = (b.y - a.y) / cell;
  clip(x, dx, columns_);
  clip(y, dy, rows_);
  if (!(begin <= end)) return;
  const auto pieces = static_cast<int>(std::ceil(std::hypot(dx, dy) * (end - begin) * 3));
  for (int i = 0; i <= pieces; ++i) {
    const double share = pieces > 0 ? begin + (end - begin) * i / pieces : begin;
    const int column = std::clamp(static_cast<int>(x + dx * share), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(y + dy * share), 0, rows_ - 1);
    take(column, row, share);
  }
}

void RoomBuilder::Print(Point a, Point b, double z_mm) {
  const RoomHeight z = InRoomHeight(z_mm);
  ForEachCell(a, b, [&](int column, int row, double) {
    RoomHeight& top = now_[Index(column, row)];
    top = std::max(top, z);
    printed_.Add(column, row);
  });
}

void RoomBuilder::Visit(Point a, double z_a_mm, Point b, double z_b_mm) {
  if (a == b) z_a_mm = z_b_mm = std::min(z_a_mm, z_b_mm);
  pass_low_ = std::min(pass_low_, InRoomHeight(std::min(z_a_mm, z_b_mm)));
  ForEachCell(a, b, [&](int column, int row, double share) {
    RoomHeight& lowest = lowest_[Index(column, row)];
    lowest = std::min(lowest, InRoomHeight(z_a_mm + (z_b_mm - z_a_mm) * share));
    visited_.Add(column, row);
  });
}

// Of the head, in the pass.
RoomHeight RoomBuilder::LowestAt(int column, int row) const {
  const bool inside = visited_.column_begin <= column && column < visited_.column_end &&
                      visited_.row_begin <= row && row < visited_.row_end;
  return inside ? lowest_[Index(column, row)] : kNever;
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
    if (x < visited_.column_begin || x >= visited_.column_end || y < visited_.row_begin ||
        y >= visited_.row_end) {
      continue;
    }
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
  map.low_ = low_;
  map.cell_mm_ = part_.cell_mm;
  const RoomHeight least = std::max(InRoomHeight(part_.least_excess_mm), kLevel);
  if (!visited_.empty() && highest_ > pass_low_ + least) {
    const int row_end = std::min(visited_.row_end + reach_, rows_);
    const int column_end = std::min(visited_.column_end + reach_, columns_);
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
