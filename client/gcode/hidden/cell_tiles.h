// A part of a layer's plane for look-ups, in little memory: squares of 8 by 8 cells, of which only
// those on an edge of the part are stored.

#ifndef TRAVERSE_CLIENT_GCODE_HIDDEN_CELL_TILES_H_
#define TRAVERSE_CLIENT_GCODE_HIDDEN_CELL_TILES_H_

#include <cstdint>
#include <vector>

#include "client/gcode/hidden/cell_rows.h"

namespace traverse::gcode {

class CellTiles {
 public:
  CellTiles() = default;  // no cell
  explicit CellTiles(const CellRows& rows);

  bool Has(int column, int row) const;

 private:
  static constexpr int kSide = 8;

  CellBox box_;  // its row is a multiple of kSide
  int tiles_across_ = 0;
  std::vector<uint64_t> full_;   // bit per tile: all of its cells
  std::vector<uint64_t> mixed_;  // bit per tile: some of them
  std::vector<uint32_t> rank_;   // [word of mixed_] stored tiles before it
  std::vector<uint64_t> tiles_;  // the mixed ones, row by row of cells
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_HIDDEN_CELL_TILES_H_
