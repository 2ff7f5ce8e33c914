// Text tables for terminals.

#ifndef TRAVERSE_CLIENT_REPORT_TABLE_H_
#define TRAVERSE_CLIENT_REPORT_TABLE_H_

#include <cassert>
#include <cstddef>
#include <string>
#include <vector>

namespace traverse::report {

// What may be done to text.
struct TextStyle {
  int width = 1'000'000;  // columns there are
  bool color = false;     // ANSI colors
  bool blocks = true;     // block characters of UTF-8; else bars are of '#'
};

enum class Color { kNone, kGood, kBad, kBar };

// One cell.
struct Cell {
  std::string text;
  Color color = Color::kNone;
};

// Columns of cells, the first one set to the left, the others to the right.
class Table {
 public:
  explicit Table(std::vector<std::string> header);

  // REQUIRES: as many cells as the header has.
  void Add(std::vector<Cell> cells) {
    assert(cells.size() == rows_.front().size());
    rows_.push_back(std::move(cells));
  }

  // The same for a row whose first cell may be `width` columns wide: a longer text goes on in rows
  // of its own below, broken before its colons.
  void AddFolded(std::vector<Cell> cells, size_t width);

  // Sets the last column to the left too: bars and texts.
  void SetLastLeft() { last_left_ = true; }

  // All rows, each ended by a newline, columns two blanks apart; a line under the header.
  std::string Text(const TextStyle& style = {}) const;

 private:
  std::vector<std::vector<Cell>> rows_;
  bool last_left_ = false;
};

// Columns that `text` takes: its letters, of UTF-8, each one column wide.
size_t TextWidth(const std::string& text);

// `text` in lines of up to `width` columns, broken before colons alone, all but the first one
// indented by two blanks. A piece that is wider stays whole.
std::vector<std::string> FoldAtColons(const std::string& text, size_t width);

// A bar of at most `cells` columns for `fraction` in [0, 1] of them, to an eighth of a column with
// blocks.
std::string Bar(double fraction, int cells, const TextStyle& style);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_TABLE_H_
