// Text tables for terminals.

#ifndef TRAVERSE_CLIENT_REPORT_TABLE_H_
#define TRAVERSE_CLIENT_REPORT_TABLE_H_

#include <cassert>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace traverse::report {

// How text may be styled.
struct TextStyle {
  int width = 1'000'000;  // available columns
  bool color = false;     // ANSI colors
  bool blocks = true;     // block characters of UTF-8; otherwise bars are of '#'
};

enum class Color { kNone, kGood, kBad, kBar };

// One cell.
struct Cell {
  std::string text;
  Color color = Color::kNone;
};

// Columns of cells: the first one is aligned left, the others right.
class Table {
 public:
  explicit Table(std::vector<std::string> header);

  // REQUIRES: as many cells as the header has.
  void Add(std::vector<Cell> cells) {
    assert(cells.size() == rows_.front().size());
    rows_.push_back(std::move(cells));
  }

  // The same for a row whose first cell may be `width` columns wide: a longer text continues in
  // rows of its own below, broken before its colons.
  void AddFolded(std::vector<Cell> cells, size_t width);

  // Aligns the last column left too: for bars and texts.
  void SetLastLeft() { last_left_ = true; }

  // All rows, each ended by a newline, with columns two blanks apart and a line under the header.
  std::string Text(const TextStyle& style = {}) const;

 private:
  std::vector<std::vector<Cell>> rows_;
  bool last_left_ = false;
};

// The columns that `text` takes: its UTF-8 letters, each one column wide.
size_t TextWidth(const std::string& text);

// `text` in lines of up to `width` columns, broken only before colons; all but the first are
// indented by two blanks. A wider piece stays whole.
std::vector<std::string> FoldAtColons(const std::string& text, size_t width);

// A bar that fills `fraction` in [0, 1] of `cells` columns, to an eighth of a column with
// blocks.
std::string Bar(double fraction, int cells, const TextStyle& style);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_TABLE_H_
