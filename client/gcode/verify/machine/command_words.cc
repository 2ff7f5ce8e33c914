#include "client/gcode/verify/machine/command_words.h"

#include <algorithm>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Numbers beyond this are not followed.
constexpr Nano kMaxNumber = 1'000'000'000;

// Reads a number without an exponent, in units of 1e-9: further decimals are left out. Moves `at`
// behind it. False if there is none, or one beyond kMaxNumber.
bool ReadNumber(const char*& at, const char* end, Nano& number) {
  constexpr int kDecimals = 9;
  if (*at == '+') ++at;
  const bool negative = at < end && *at == '-';
  if (negative) ++at;
  bool any = false;
  int decimals = -1;  // none before the point
  number = 0;
  for (; at < end; ++at) {
    const auto digit = static_cast<unsigned char>(*at - '0');
    if (digit > 9 && (*at != '.' || decimals >= 0)) break;
    if (digit > 9) {
      decimals = 0;
      continue;
    }
    any = true;
    if (decimals == kDecimals) continue;
    number = number * 10 + digit;
    if (decimals >= 0) {
      ++decimals;
    } else if (number > kMaxNumber) {
      return false;
    }
  }
  for (decimals = std::max(decimals, 0); decimals < kDecimals; ++decimals) number *= 10;
  const bool fits = number <= kMaxNumber * 1'000'000'000;
  if (negative) number = -number;
  return any && fits;
}

bool IsLetter(char c) { return UpperCase(c) >= 'A' && UpperCase(c) <= 'Z'; }

}  // namespace

CommandWords::CommandWords(std::string_view text) {
  text = TrimLine(text);
  const char* const end = text.data() + text.size();
  const auto skip_blanks = [end](const char* at) {
    while (at < end && (*at == ' ' || *at == '\t')) ++at;
    return at;
  };
  for (const char* at = text.data(); at < end; at = skip_blanks(at)) {
    const char letter = UpperCase(*at);
    readable = IsLetter(letter) && !Has(letter);
    if (!readable) return;
    at = skip_blanks(at + 1);
    Nano number = 0;
    readable = at == end || IsLetter(*at) || ReadNumber(at, end, number);
    if (!readable) return;
    if (letter == 'E') filament = number;
    set |= 1u << (letter - 'A');
    values[static_cast<size_t>(letter - 'A')] = InMicros(number);
  }
}

std::string_view WordsOf(std::string_view line) {
  const std::string_view code = line.substr(0, line.find(';'));
  size_t digits = 1;
  while (digits < code.size() && code[digits] >= '0' && code[digits] <= '9') ++digits;
  return digits < code.size() ? code.substr(digits) : std::string_view{};
}

}  // namespace traverse::gcode
