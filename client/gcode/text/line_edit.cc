#include "client/gcode/text/line_edit.h"

#include <cstdint>

#include "client/gcode/text/lexer.h"

namespace traverse::gcode {

void AppendEdited(std::string_view line, absl::Span<const WordChange> changes, std::string& out) {
  uint32_t made = 0;  // letters
  size_t copied = 0;
  WordCursor word(line.substr(0, line.find_last_not_of("\r\n") + 1));
  while (word.Next()) {
    for (const WordChange& change : changes) {
      if (change.letter != word.letter()) continue;
      out.append(line, copied, word.value_begin() - copied);
      AppendDecimal(change.value, change.style, out);
      copied = word.value_end();
      made |= Command::Bit(change.letter);
    }
  }
  out.append(line, copied, word.value_end() - copied);
  copied = word.value_end();
  for (const WordChange& change : changes) {
    if ((made & Command::Bit(change.letter)) != 0) continue;
    out.push_back(' ');
    out.push_back(change.letter);
    AppendDecimal(change.value, change.style, out);
  }
  out.append(line, copied, std::string_view::npos);
}

}  // namespace traverse::gcode
