#include "client/gcode/verify/machine/command_words.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Numbers beyond this are not followed.
constexpr double kMaxNumber = 1e9;

// The bytes of [begin, end) from `at` on in one word, the first one lowest, and zeros behind `end`.
// REQUIRES: begin <= at < end.
uint64_t Load(const char* begin, const char* at, const char* end) {
  assert(begin <= at && at < end);
  uint64_t bytes = 0;
  if (end - begin < 8) {
    for (const char* p = end; p-- > at;) bytes = bytes << 8 | static_cast<unsigned char>(*p);
    return bytes;
  }
  const char* const from = std::min(at, end - 8);
  std::memcpy(&bytes, from, 8);
  if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
  return bytes >> (8 * (at - from));
}

// The digits with which `bytes` begins, and their value; 0 if all eight are digits, for the number
// may go on.
Micro Digits(uint64_t bytes, size_t& count) {
  constexpr uint64_t kEach = 0x0101010101010101u;
  const uint64_t less = bytes ^ (kEach * '0');
  // Bytes up to the first one that is no digit carry nothing over to it.
  const uint64_t above_nine = (less + kEach * (127 - 9)) | less;
  count = static_cast<size_t>(std::countr_zero(above_nine & (kEach * 128))) / 8;
  if (count == 0 || count == 8) return 0;
  uint64_t value = less << (8 * (8 - count));  // leading zeros
  value = (value * 10 + (value >> 8)) & 0x00ff00ff00ff00ffu;
  value = (value * 100 + (value >> 16)) & 0x0000ffff0000ffffu;
  value = (value * 10'000 + (value >> 32)) & 0xffffffffu;
  return static_cast<Micro>(value);
}

// The numbers that slicers write: up to seven digits, and six decimals. `at` and `end` are within a
// text that begins at `begin`; moves `at` past the number. False if there is no such number.
bool PlainNumber(const char* begin, const char*& at, const char* end, Micro& value) {
  constexpr Micro kScale[] = {1'000'000, 100'000, 10'000, 1'000, 100, 10, 1};
  const char* p = at;
  const bool negative = *p == '-';
  if (negative && ++p == end) return false;
  size_t whole = 0;
  value = Digits(Load(begin, p, end), whole) * kScale[0];
  p += whole;
  size_t decimals = 0;
  if (whole < 8 && p < end && *p == '.' && ++p < end) {
    const Micro fraction = Digits(Load(begin, p, end), decimals);
    if (decimals > 6) return false;
    value += fraction * kScale[decimals];
    p += decimals;
  }
  if (whole == 8 || whole + decimals == 0) return false;
  at = p;
  if (negative) value = -value;
  return true;
}

// The number that stands at [at, end), with nine decimals.
Nano WithNineDecimals(const char* at, const char* end) {
  const bool negative = *at == '-';
  if (negative || *at == '+') ++at;
  Nano value = 0;
  int decimals = -1;  // none before the point
  for (; at < end && decimals < 9; ++at) {
    if (*at != '.') value = value * 10 + (*at - '0');
    if (*at == '.' || decimals >= 0) ++decimals;
  }
  for (decimals = std::max(decimals, 0); decimals < 9; ++decimals) value *= 10;
  return negative ? -value : value;
}

bool Number(const char* begin, const char*& at, const char* end, Micro& value, Nano& nanos) {
  if (PlainNumber(begin, at, end, value)) {
    nanos = value * 1000;
    return true;
  }
  const char* const first = *at == '+' ? at + 1 : at;
  double number = 0;
  const auto result = std::from_chars(first, end, number, std::chars_format::fixed);
  if (result.ec != std::errc{} || !(std::abs(number) <= kMaxNumber)) return false;
  at = result.ptr;
  nanos = WithNineDecimals(first, at);
  value = InMicros(nanos);
  return true;
}

bool IsLetter(char c) { return UpperCase(c) >= 'A' && UpperCase(c) <= 'Z'; }

}  // namespace

CommandWords::CommandWords(std::string_view text) {
  text = TrimLine(text);
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const auto skip_blanks = [end](const char* at) {
    while (at < end && (*at == ' ' || *at == '\t')) ++at;
    return at;
  };
  for (const char* at = begin; at < end; at = skip_blanks(at)) {
    const char letter = UpperCase(*at);
    readable = IsLetter(letter) && !Has(letter);
    if (!readable) return;
    at = skip_blanks(at + 1);
    Micro value = 0;
    Nano nanos = 0;
    readable = at == end || IsLetter(*at) || Number(begin, at, end, value, nanos);
    if (!readable) return;
    if (letter == 'E') filament = nanos;
    set |= 1u << (letter - 'A');
    values[static_cast<size_t>(letter - 'A')] = value;
  }
}

std::string_view WordsOf(std::string_view line) {
  const std::string_view code = line.substr(0, line.find(';'));
  size_t digits = 1;
  while (digits < code.size() && code[digits] >= '0' && code[digits] <= '9') ++digits;
  return digits < code.size() ? code.substr(digits) : std::string_view{};
}

}  // namespace traverse::gcode
