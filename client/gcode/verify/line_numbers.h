// Checks numbers and checksums of lines for the verifier: would a machine accept them? And the
// digest that a file may state of itself.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_LINE_NUMBERS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_LINE_NUMBERS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::gcode {

// A text whose lines were numbered: from some command on each has its number, equal steps apart,
// and all have a correct checksum, or none has one.
struct Unnumbered {
  std::string text;  // without them; each line is at the same position

  // A digest of where the numbers begin, their steps, and whether there are checksums.
  uint64_t form = 0;
};

// Unset for any other text.
std::optional<Unnumbered> WithoutNumbers(std::string_view text);

// True if the first line of `text` is `; MD5:` and the 32 hexadecimal digits of the MD5 of all that
// follows it. Such lines are equal in two texts, whatever these are; a wrong one is a comment.
bool HasRightMd5(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_LINE_NUMBERS_H_
