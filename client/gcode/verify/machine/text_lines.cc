#include "client/gcode/verify/machine/text_lines.h"

#include <algorithm>

namespace traverse::gcode {

bool TextLines::Next(std::string_view& line) {
  if (rest_.empty()) return false;
  ++number_;
  // Where carriage returns alone end lines, all of them are before one line feed.
  if (line_feed_ == nullptr || line_feed_ < rest_.data()) {
    line_feed_ = rest_.data() + std::min(rest_.find('\n'), rest_.size());
  }
  const auto end = static_cast<size_t>(line_feed_ - rest_.data());
  line = rest_.substr(0, end);
  if (return_ == nullptr || return_ < rest_.data()) {
    return_ = rest_.data() + std::min(rest_.find('\r'), rest_.size());
  }
  size_t returns = 0;
  if (return_ < line_feed_) {
    while (returns < line.size() && line[line.size() - 1 - returns] == '\r') ++returns;
    const auto inside = static_cast<size_t>(return_ - rest_.data());
    if (inside < line.size() - returns) {
      NoteEnd(kMostReturns + 1);
      rest_.remove_prefix(inside + 1);
      line = line.substr(0, inside);
      return true;
    }
  }
  if (end < rest_.size()) NoteEnd(std::min(returns, kMostReturns));
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  line.remove_suffix(returns);
  return true;
}

void TextLines::NoteEnd(size_t bit) {
  if ((ends_ >> bit & 1u) == 0) first_with_end_[bit] = number_;
  ends_ |= 1u << bit;
}

uint32_t TextLines::FirstWithEnds(uint32_t ends) const {
  uint32_t first = 0;
  for (size_t bit = 0; bit < first_with_end_.size(); ++bit) {
    if ((ends & ends_ & 1u << bit) == 0) continue;
    if (first == 0 || first_with_end_[bit] < first) first = first_with_end_[bit];
  }
  return first;
}

}  // namespace traverse::gcode
