// Text tables for terminals.

#ifndef TRAVERSE_CLIENT_REPORT_TABLE_H_
#define TRAVERSE_CLIENT_REPORT_TABLE_H_

#include <string>
#include <vector>

namespace traverse::report {

// Columns of cells, the first one set to the left, the others to the right.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : rows_({std::move(header)}) {}

  // REQUIRES: as many cells as the header has.
  void Add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  // All rows, each ended by a newline, columns two blanks apart; a line under the header. Cells are
  // UTF-8; a letter counts as one column wide.
  std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_TABLE_H_
