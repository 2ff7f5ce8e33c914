// The words of one command: `X1.5 Y-2 E.03` as integers of 1e-6.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_COMMAND_WORDS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_COMMAND_WORDS_H_

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace traverse::gcode {

// In units of 1e-6, and of 1e-9, of what the file's words count in.
using Micro = int64_t;
using Nano = int64_t;

inline constexpr double kMicro = 1e-6;
inline constexpr double kInchMm = 25.4;

// The nearest; of two the one farther from zero.
inline Micro InMicros(Nano value) { return (value + (value < 0 ? -500 : 500)) / 1000; }

// A letter that is there twice, or whose number is none, makes the command unreadable.
struct CommandWords {
  // `text` is what stands between the command's name and its comment.
  explicit CommandWords(std::string_view text);

  bool Has(char letter) const { return (set >> (letter - 'A')) & 1u; }

  // It is readable, and has no letters but these.
  bool OnlyFrom(std::string_view letters) const {
    uint32_t known = 0;
    for (const char c : letters) known |= 1u << (c - 'A');
    return readable && (set & ~known) == 0;
  }

  // REQUIRES: Has(letter).
  Micro operator[](char letter) const {
    assert(Has(letter));
    return values[static_cast<size_t>(letter - 'A')];
  }

  // The same, or `other` if there is no such word.
  Micro ValueOr(char letter, Micro other) const { return Has(letter) ? (*this)[letter] : other; }

  bool readable = true;
  uint32_t set = 0;              // bit (letter - 'A')
  std::array<Micro, 26> values;  // those in `set`

  // The value of E, if it is in `set`, without the decimals beyond nine. Filament is the difference
  // of such values: rounded to a millionth before, it would depend on where the register stands.
  Nano filament = 0;
};

// What stands between the name of the G or M command `line` and its comment.
std::string_view WordsOf(std::string_view line);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_COMMAND_WORDS_H_
