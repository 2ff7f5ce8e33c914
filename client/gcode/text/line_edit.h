// Changes some words of a line. Everything else stays: blanks, order of words, comment, line
// end.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_LINE_EDIT_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_LINE_EDIT_H_

#include <string>
#include <string_view>

#include "absl/types/span.h"
#include "client/gcode/text/decimal.h"

namespace traverse::gcode {

// A new word of a line: `value` in `style` replaces the word with this letter, or follows the last
// word if there is none.
struct WordChange {
  char letter = 0;
  Decimal value = 0;
  NumberStyle style;
};

// Appends `line` (with its line end) to `out` with the changes made.
void AppendEdited(std::string_view line, absl::Span<const WordChange> changes, std::string& out);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_LINE_EDIT_H_
