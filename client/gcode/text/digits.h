// Numbers of at most seven digits on either side of the point, read eight bytes at a time: most
// numbers of G-code. Loops over their digits would end where no processor can foresee it.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_DIGITS_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_DIGITS_H_

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "client/gcode/text/decimal.h"

namespace traverse::gcode {

inline constexpr size_t kDigitsAtOnce = 8;

// The bytes of [line, end) from `p` on less '0', the first one lowest; those beyond `end` are none
// of a digit. REQUIRES: line <= p < end, and the line has at least eight bytes.
inline uint64_t DigitsFrom(const char* p, const char* end) {
  const char* const at = std::min(p, end - kDigitsAtOnce);
  uint64_t bytes = 0;
  std::memcpy(&bytes, at, kDigitsAtOnce);
  return (bytes >> (8 * static_cast<size_t>(p - at))) ^ 0x3030303030303030u;
}

// How many bytes of `digits` are digits, up to the first one that is none.
inline size_t CountDigits(uint64_t digits) {
  // The highest bit of a byte is set where it is above 9; what it carries over goes to bytes
  // behind.
  const uint64_t others = (digits | (digits + 0x7676767676767676u)) & 0x8080808080808080u;
  return static_cast<size_t>(std::countr_zero(others)) / 8;
}

// The number that eight digits make: pairs first, then fours, then both fours.
inline uint64_t ValueOfDigits(uint64_t digits) {
  digits = digits * 10 + (digits >> 8);
  digits = ((digits & 0x00ff00ff00ff00ffu) * ((100u << 16) + 1)) >> 16;
  return ((digits & 0x0000ffff0000ffffu) * ((uint64_t{10'000} << 32) + 1)) >> 32;
}

// Reads the number at `*text` in the line [line, end) as ParseDecimal does, if it is that short and
// the line long enough. Else false, and `*text` stays. REQUIRES: line <= *text < end.
inline bool ParseShort(const char* line, const char** text, const char* end, Decimal& value) {
  assert(line <= *text && *text < end);
  if constexpr (std::endian::native != std::endian::little) return false;
  if (static_cast<size_t>(end - line) < kDigitsAtOnce) return false;
  const char* p = *text;
  const bool negative = *p == '-';
  if (negative || *p == '+') ++p;
  if (p == end) return false;
  const uint64_t first = DigitsFrom(p, end);
  const size_t whole_digits = CountDigits(first);
  if (whole_digits == kDigitsAtOnce) return false;
  // In two steps: there may be no digit.
  const uint64_t whole = ValueOfDigits(first << (8 * (kDigitsAtOnce - 1 - whole_digits)) << 8);
  value = static_cast<Decimal>(whole) * kDecimalOne;
  size_t decimals = 0;
  p += whole_digits;
  if (p < end && *p == '.' && ++p < end) {
    const uint64_t behind_point = DigitsFrom(p, end);
    decimals = CountDigits(behind_point);
    if (decimals == kDigitsAtOnce) return false;
    const uint64_t only = behind_point & ((uint64_t{1} << (8 * decimals)) - 1);
    value += static_cast<Decimal>(ValueOfDigits(only)) * (kDecimalOne / 100'000'000);
    p += decimals;
  }
  if (whole_digits + decimals == 0) return false;
  *text = p;
  if (negative) value = -value;
  return true;
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_DIGITS_H_
