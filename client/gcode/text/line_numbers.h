// Numbers and checksums of lines, as hosts send them and some programs store them:
//
//   N12 G1 X121.016 E.03272*71
//
// The checksum is the exclusive or of all bytes before its asterisk (RepRap's G-code dialect). A
// machine drops a line with a wrong checksum, and stops at one whose number is not the next. So
// lines move without numbers and checksums, which are added again at the end.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_LINE_NUMBERS_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_LINE_NUMBERS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "client/gcode/text/lexer.h"

namespace traverse::gcode {

// How the commands of a file are numbered. Comments and blank lines have no number.
struct LineNumbers {
  size_t commands_before = 0;  // at the beginning, without numbers
  int64_t first = 0;
  int64_t step = 1;
  std::string blanks;         // between number and command
  std::string blanks_behind;  // between that and the checksum
  bool checksums = false;
  bool behind_comments = false;  // checksums stand after the comment of a line, not before it

  friend bool operator==(const LineNumbers&, const LineNumbers&) = default;
};

// The numbering of `text`, by its first two numbered lines; unset if it has none.
std::optional<LineNumbers> LearnLineNumbers(std::string_view text);

// `text` without numbers and checksums, line by line.
std::string WithoutLineNumbers(std::string_view text, const LineNumbers& numbers);

// `text` with numbers, and checksums if the file has them.
std::string WithLineNumbers(std::string_view text, const LineNumbers& numbers);

// Where the first line in which `text` and `other` differ begins; unset if they are equal.
std::optional<Offset> FirstOtherLine(std::string_view text, std::string_view other);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_LINE_NUMBERS_H_
