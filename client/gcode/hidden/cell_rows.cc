#include "client/gcode/hidden/cell_rows.h"

#include <algorithm>

namespace traverse::gcode {

template <typename Visit>
void CellRows::ForEachWord(int begin, int end, Visit visit) {
  for (int word = begin / kWordCells; word * kWordCells < end; ++word) {
    const int first = std::max(begin - word * kWordCells, 0);
    const int behind = std::min(end - word * kWordCells, kWordCells);
    const uint64_t below = behind == kWordCells ? ~uint64_t{0} : (uint64_t{1} << behind) - 1;
    visit(static_cast<size_t>(word), below & (~uint64_t{0} << first));
  }
}

uint64_t CellRows::WordAt(int word, int row) const {
  const int own = word - box_.column / kWordCells;
  if (row < box_.row || row >= box_.row + box_.rows || own < 0 || own >= box_.words) return 0;
  return words_[FirstOf(row) + static_cast<size_t>(own)];
}

void CellRows::Set(int row, int begin, int end) {
  if (row < box_.row || row >= box_.row + box_.rows) return;
  begin = std::max(begin - box_.column, 0);
  end = std::min(end - box_.column, box_.words * kWordCells);
  if (begin >= end) return;
  const absl::Span<uint64_t> words = Row(row);
  ForEachWord(begin, end, [words](size_t word, uint64_t mask) { words[word] |= mask; });
}

bool CellRows::Any(int row, int begin, int end) const {
  const absl::Span<const uint64_t> words = Row(row);
  bool any = false;
  ForEachWord(begin - box_.column, end - box_.column,
              [&](size_t word, uint64_t mask) { any = any || (words[word] & mask) != 0; });
  return any;
}

bool CellRows::All(int row, int begin, int end) const {
  const absl::Span<const uint64_t> words = Row(row);
  bool all = true;
  ForEachWord(begin - box_.column, end - box_.column,
              [&](size_t word, uint64_t mask) { all = all && (words[word] & mask) == mask; });
  return all;
}

void CellRows::Intersect(const CellRows& other) {
  const int first = box_.column / kWordCells;
  for (int row = box_.row; row < box_.row + box_.rows; ++row) {
    const absl::Span<uint64_t> words = Row(row);
    for (int word = 0; word < box_.words; ++word) {
      words[static_cast<size_t>(word)] &= other.WordAt(first + word, row);
    }
  }
}

}  // namespace traverse::gcode
