// Numbers and checksums of lines, for the verifier: are they such as a machine takes them?

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_LINE_NUMBERS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_LINE_NUMBERS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::gcode {

// A text whose lines were numbered: from a command on each has its number, equal steps apart, and
// all have a checksum, which is right, or none has.
struct Unnumbered {
  std::string text;  // without them; each line is where it was

  // Of where the numbers begin, the steps, and whether there are checksums: how they run on.
  uint64_t form = 0;
};

// Nothing for a text that is not like that.
std::optional<Unnumbered> WithoutNumbers(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_LINE_NUMBERS_H_
