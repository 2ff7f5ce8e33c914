#include "client/report/table.h"

#include <algorithm>
#include <cstddef>

namespace traverse::report {
namespace {

// Letters in UTF-8: bytes that do not continue one.
size_t Width(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string Table::Text() const {
  std::vector<size_t> widths(rows_.front().size());
  for (const std::vector<std::string>& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], Width(row[i]));
  }
  std::string out;
  for (size_t r = 0; r < rows_.size(); ++r) {
    std::string line;
    for (size_t i = 0; i < rows_[r].size(); ++i) {
      const std::string& cell = rows_[r][i];
      const std::string blanks(widths[i] - Width(cell), ' ');
      line += (i == 0 ? "" : "  ") + (i == 0 ? cell + blanks : blanks + cell);
    }
    line.resize(line.find_last_not_of(' ') + 1);
    out += line + '\n';
    if (r > 0) continue;
    for (size_t i = 0; i < widths.size(); ++i)
      out += (i == 0 ? "" : "  ") + std::string(widths[i], '-');
    out += '\n';
  }
  return out;
}

}  // namespace traverse::report
