// Lines with some of their words changed. Everything else of a line stays: blanks, order of words,
// comment, line end.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_LINE_EDIT_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_LINE_EDIT_H_

#include <string>
#include <string_view>

#include "absl/types/span.h"
#include "client/gcode/text/decimal.h"

namespace traverse::gcode {

// A word of a line: `value` in `style`, put in place of the one with this letter, or behind the
// last word if there is none.
struct WordChange {
  char letter = 0;
  Decimal value = 0;
  NumberStyle style;
};

// Appends `line` (with its line end) to `out` with the changes made.
void AppendEdited(std::string_view line, absl::Span<const WordChange> changes, std::string& out);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_LINE_EDIT_H_
