// Lines and words of G-code, without copying.
//
// A line ends at LF; a CR before it belongs to the line end. A line contains:
//
//   G1 X121.016 Y109.474 E.03272 ; infill      command: letter, number, words, comment
//   ;TYPE:Perimeter                            comment
//   START_PRINT BED_TEMP=60                    text: anything else, not looked into
//
// Letters may be small. Blanks between and before words are skipped, and may be missing (`G1X5Y2`).

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_LEXER_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_LEXER_H_

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "client/gcode/text/decimal.h"

namespace traverse::gcode {

// A position in a file. Files of 4 GiB and more are refused before they are read.
using Offset = uint32_t;

// One line of a text: [begin, end) without its line end, which `next` follows.
struct Line {
  Offset begin = 0;
  Offset end = 0;
  Offset next = 0;

  std::string_view Text(std::string_view text) const { return text.substr(begin, end - begin); }
  std::string_view Raw(std::string_view text) const { return text.substr(begin, next - begin); }
};

// The line that begins at `begin`. REQUIRES: begin < text.size().
inline Line LineAt(std::string_view text, Offset begin) {
  assert(begin < text.size());
  const char* const start = text.data() + begin;
  const void* const found = std::memchr(start, '\n', text.size() - begin);
  Line line;
  line.begin = begin;
  if (found == nullptr) {
    line.end = line.next = static_cast<Offset>(text.size());
  } else {
    line.end = static_cast<Offset>(static_cast<const char*>(found) - text.data());
    line.next = line.end + 1;
  }
  while (line.end > line.begin && text[line.end - 1] == '\r') --line.end;  // IceSL: CR CR LF
  return line;
}

enum class LineKind : uint8_t { kBlank, kComment, kCommand, kText };

// The contents of one line.
struct Command {
  LineKind kind = LineKind::kBlank;
  char letter = 0;           // kCommand: 'G', 'M' or 'T'
  int number = 0;            // kCommand: 1 in `G1`
  uint32_t words = 0;        // kCommand: bit (letter - 'A') for each word read
  Decimal values[26];        // [letter - 'A'], set for the letters in `words`
  std::string_view rest;     // kCommand: what follows letter and number, without comment
  std::string_view comment;  // from its semicolon on; empty if there is none

  static constexpr uint32_t Bit(char letter) { return 1u << (letter - 'A'); }
  bool Has(char letter) const { return (words & Bit(letter)) != 0; }
  Decimal Value(char letter) const { return values[letter - 'A']; }
  bool Is(char command_letter, int command_number) const {
    return kind == LineKind::kCommand && letter == command_letter && number == command_number;
  }

  // G0 to G3.
  bool Moves() const { return kind == LineKind::kCommand && letter == 'G' && number <= 3; }
};

// Reads the line `text` (without line end) into `command`. Reads the words of G0 to G3 and of G92
// at once; if they cannot be read (an unknown shape, a letter twice, a number that ParseDecimal
// refuses), the line is kText. ReadWords reads those of other commands when they are needed.
void LexLine(std::string_view text, Command& command);

// Reads the words of `command.rest`. Returns false, with `words` 0, if some cannot be read. A
// letter without a number is a word of value 0.
bool ReadWords(Command& command);

// Iterates over the words of a command line: `for (WordCursor c(line); c.Next();)`.
class WordCursor {
 public:
  explicit WordCursor(std::string_view line) : line_(line) {}

  // Moves to the next word, including the command; false at the end or at a comment.
  bool Next();

  char letter() const { return letter_; }  // in capitals
  size_t value_begin() const { return value_begin_; }
  size_t value_end() const { return value_end_; }
  std::string_view value() const { return line_.substr(value_begin_, value_end_ - value_begin_); }

 private:
  std::string_view line_;
  char letter_ = 0;
  size_t value_begin_ = 0;
  size_t value_end_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_LEXER_H_
