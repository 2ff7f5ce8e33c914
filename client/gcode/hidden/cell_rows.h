// A part of a layer's plane as cells of one size, rows of bits. All such maps of one size share
// their grid, so that those of several layers can be combined.

#ifndef TRAVERSE_CLIENT_GCODE_HIDDEN_CELL_ROWS_H_
#define TRAVERSE_CLIENT_GCODE_HIDDEN_CELL_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"

namespace traverse::gcode {

// Cells [column, column + 64 * words) by [row, row + rows) of the grid.
struct CellBox {
  int column = 0;  // a multiple of 64, so that words of two maps hold the same columns
  int row = 0;
  int words = 0;
  int rows = 0;

  bool operator==(const CellBox&) const = default;
};

class CellRows {
 public:
  static constexpr int kWordCells = 64;

  CellRows() = default;  // no cell
  explicit CellRows(const CellBox& box)
      : box_(box), words_(static_cast<size_t>(box.words) * static_cast<size_t>(box.rows)) {}

  const CellBox& box() const { return box_; }

  // Bits of row `row` of the grid. REQUIRES: the box has it.
  absl::Span<uint64_t> Row(int row) { return {words_.data() + FirstOf(row), RowWords()}; }
  absl::Span<const uint64_t> Row(int row) const {
    return {words_.data() + FirstOf(row), RowWords()};
  }

  // Word `word` of the grid, which is columns [64 * word, 64 * word + 64), in row `row`; 0 outside
  // the box.
  uint64_t WordAt(int word, int row) const;

  // Sets the cells [begin, end) of a row, as far as the box has them.
  void Set(int row, int begin, int end);

  // Whether any, or all, of the cells [begin, end) of a row are set. REQUIRES: the box has them.
  bool Any(int row, int begin, int end) const;
  bool All(int row, int begin, int end) const;

  // Keeps the cells that `other` has as well.
  void Intersect(const CellRows& other);

 private:
  size_t RowWords() const { return static_cast<size_t>(box_.words); }
  size_t FirstOf(int row) const { return static_cast<size_t>(row - box_.row) * RowWords(); }

  // Calls visit(word of the row, mask) for the words of the cells [begin, end) of the box.
  template <typename Visit>
  static void ForEachWord(int begin, int end, Visit visit);

  CellBox box_;
  std::vector<uint64_t> words_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_HIDDEN_CELL_ROWS_H_
