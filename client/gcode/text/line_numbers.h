// Numbers and checksums of lines, as hosts send them and some programs store them:
//
//   N12 G1 X121.016 E.03272*71
//
// The checksum is the exclusive or of all bytes before its asterisk (RepRap's G-code dialect). A
// machine drops a line whose checksum is wrong, and stops at one whose number is not the next: so
// lines change places without these, and are numbered anew.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_LINE_NUMBERS_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_LINE_NUMBERS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "client/gcode/text/lexer.h"

namespace traverse::gcode {

// How the commands of a file are numbered. Comments and blank lines are not.
struct LineNumbers {
  size_t commands_before = 0;  // that are not numbered, at the beginning
  int64_t first = 0;
  int64_t step = 1;
  std::string blanks;  // between number and command
  bool checksums = false;
  bool behind_comments = false;  // a checksum stands behind the comment of its line, not before it

  friend bool operator==(const LineNumbers&, const LineNumbers&) = default;
};

// The numbers of `text` by its first two numbered lines; nothing if it has no such line.
std::optional<LineNumbers> LearnLineNumbers(std::string_view text);

// `text` without numbers and checksums, line by line.
std::string WithoutLineNumbers(std::string_view text, const LineNumbers& numbers);

// `text` with numbers, and checksums if the file has them.
std::string WithLineNumbers(std::string_view text, const LineNumbers& numbers);

// Where the first line begins in which `text` and `other` differ; nothing if they are equal.
std::optional<Offset> FirstOtherLine(std::string_view text, std::string_view other);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_LINE_NUMBERS_H_
