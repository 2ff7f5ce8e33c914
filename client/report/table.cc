#include "client/report/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace traverse::report {
namespace {

std::string Colored(const Cell& cell, const TextStyle& style) {
  if (!style.color || cell.color == Color::kNone) return cell.text;
  const char* code = cell.color == Color::kGood  ? "\x1b[1;32m"
                     : cell.color == Color::kBad ? "\x1b[31m"
                                                 : "\x1b[36m";
  return code + cell.text + "\x1b[0m";
}

}  // namespace

size_t TextWidth(const std::string& text) {
  // Bytes that do not continue a letter.
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string Bar(double fraction, int cells, const TextStyle& style) {
  const double filled = std::clamp(fraction, 0.0, 1.0) * std::max(cells, 0);
  if (!style.blocks) return std::string(static_cast<size_t>(std::lround(filled)), '#');
  constexpr std::array<const char*, 8> kEighths = {"",       "\u258f", "\u258e", "\u258d",
                                                   "\u258c", "\u258b", "\u258a", "\u2589"};
  const long eighths = std::lround(filled * 8);
  std::string out;
  for (long i = 0; i < eighths / 8; ++i) out += "\u2588";
  return out + kEighths[static_cast<size_t>(eighths % 8)];
}

std::vector<std::string> FoldAtColons(const std::string& text, size_t width) {
  std::vector<std::string> lines = {""};
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(':', begin + 1), text.size());
    const std::string piece = text.substr(begin, end - begin);
    if (begin > 0 && TextWidth(lines.back() + piece) > width) lines.push_back("  ");
    lines.back() += piece;
    begin = end;
  }
  return lines;
}

Table::Table(std::vector<std::string> header) {
  std::vector<Cell>& row = rows_.emplace_back();
  for (std::string& title : header) row.push_back({std::move(title)});
}

void Table::AddFolded(std::vector<Cell> cells, size_t width) {
  std::vector<std::string> lines = FoldAtColons(cells[0].text, width);
  for (size_t i = 0; i < lines.size(); ++i) {
    std::vector<Cell> row = i == 0 ? std::move(cells) : std::vector<Cell>(rows_.front().size());
    row[0].text = std::move(lines[i]);
    Add(std::move(row));
  }
}

std::string Table::Text(const TextStyle& style) const {
  std::vector<size_t> widths(rows_.front().size());
  for (const std::vector<Cell>& row : rows_) {
    for (size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], TextWidth(row[i].text));
    }
  }
  std::string out;
  for (size_t r = 0; r < rows_.size(); ++r) {
    std::string line;
    for (size_t i = 0; i < widths.size(); ++i) {
      const Cell& cell = rows_[r][i];
      const std::string blanks(widths[i] - TextWidth(cell.text), ' ');
      const bool left = i == 0 || (last_left_ && i + 1 == widths.size());
      if (i > 0) line += "  ";
      line += left ? Colored(cell, style) + blanks : blanks + Colored(cell, style);
    }
    line.resize(line.find_last_not_of(' ') + 1);
    out += line + '\n';
    if (r > 0) continue;
    for (size_t i = 0; i < widths.size(); ++i) {
      if (i > 0) out += "  ";
      out += std::string(widths[i], '-');
    }
    out += '\n';
  }
  return out;
}

}  // namespace traverse::report
