#include "client/gcode/hidden/cell_tiles.h"

#include <bit>

namespace traverse::gcode {

CellTiles::CellTiles(const CellRows& rows) : box_(rows.box()) {
  box_.row = rows.box().row & -kSide;  // rounded down
  box_.rows = rows.box().row + rows.box().rows - box_.row;
  tiles_across_ = box_.words * kSide;
  const int tiles_down = (box_.rows + kSide - 1) / kSide;
  const auto words = static_cast<size_t>(tiles_across_ * tiles_down / CellRows::kWordCells + 1);
  full_.resize(words);
  mixed_.resize(words);
  rank_.resize(words);
  const int first = box_.column / CellRows::kWordCells;
  for (int tile = 0; tile < tiles_across_ * tiles_down; ++tile) {
    const auto word = static_cast<size_t>(tile / CellRows::kWordCells);
    if (tile % CellRows::kWordCells == 0) rank_[word] = static_cast<uint32_t>(tiles_.size());
    const int row = box_.row + tile / tiles_across_ * kSide;
    const int across = tile % tiles_across_;
    uint64_t cells = 0;
    for (int i = 0; i < kSide; ++i) {
      const uint64_t of_row = rows.WordAt(first + across / kSide, row + i);
      cells |= (of_row >> (across % kSide * kSide) & 0xFFu) << (i * kSide);
    }
    const uint64_t bit = uint64_t{1} << (tile % CellRows::kWordCells);
    if (cells == ~uint64_t{0}) {
      full_[word] |= bit;
    } else if (cells != 0) {
      mixed_[word] |= bit;
      tiles_.push_back(cells);
    }
  }
  tiles_.shrink_to_fit();
}

bool CellTiles::Has(int column, int row) const {
  const int x = column - box_.column;
  const int y = row - box_.row;
  if (x < 0 || y < 0 || x >= box_.words * CellRows::kWordCells || y >= box_.rows) return false;
  const int tile = y / kSide * tiles_across_ + x / kSide;
  const auto word = static_cast<size_t>(tile / CellRows::kWordCells);
  const uint64_t bit = uint64_t{1} << (tile % CellRows::kWordCells);
  if ((full_[word] & bit) != 0) return true;
  if ((mixed_[word] & bit) == 0) return false;
  const int before = std::popcount(mixed_[word] & (bit - 1));
  const uint64_t cells = tiles_[rank_[word] + static_cast<size_t>(before)];
  return (cells >> (y % kSide * kSide + x % kSide) & 1u) != 0;
}

}  // namespace traverse::gcode
