#include "client/gcode/verify/machine/command_words.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Numbers beyond this are not followed.
constexpr double kMaxNumber = 1e9;

// The numbers that slicers write: up to nine digits, and six decimals.
std::optional<Micro> PlainNumber(std::string_view text, size_t& used) {
  constexpr Micro kScale[] = {1'000'000, 100'000, 10'000, 1'000, 100, 10, 1};
  const bool negative = !text.empty() && text[0] == '-';
  size_t at = negative ? 1 : 0;
  Micro value = 0;
  size_t digits = 0;
  const auto take = [&] {
    const size_t begin = at;
    for (; at < text.size() && text[at] >= '0' && text[at] <= '9'; ++at) {
      value = value * 10 + (text[at] - '0');
      if (++digits > 15) break;
    }
    return at - begin;
  };
  const size_t whole = take();
  size_t decimals = 0;
  if (at < text.size() && text[at] == '.') {
    ++at;
    decimals = take();
  }
  if (digits == 0 || whole > 9 || decimals > 6) return std::nullopt;
  used = at;
  return (negative ? -value : value) * kScale[decimals];
}

std::optional<Micro> Number(std::string_view text, size_t& used) {
  if (const std::optional<Micro> plain = PlainNumber(text, used)) return plain;
  size_t at = 0;
  if (!text.empty() && text[0] == '+') at = 1;
  double value = 0;
  const auto result =
      std::from_chars(text.data() + at, text.data() + text.size(), value, std::chars_format::fixed);
  if (result.ec != std::errc{} || !(std::abs(value) <= kMaxNumber)) return std::nullopt;
  used = static_cast<size_t>(result.ptr - text.data());
  return std::llround(value * 1e6);
}

bool IsLetter(char c) { return UpperCase(c) >= 'A' && UpperCase(c) <= 'Z'; }

}  // namespace

CommandWords::CommandWords(std::string_view text) {
  for (text = TrimLine(text); !text.empty(); text = TrimLine(text)) {
    const char letter = UpperCase(text[0]);
    if (!IsLetter(letter) || Has(letter)) {
      readable = false;
      return;
    }
    text = TrimLine(text.substr(1));
    Micro value = 0;
    size_t used = 0;
    if (!text.empty() && !IsLetter(text[0])) {
      const std::optional<Micro> number = Number(text, used);
      if (!number) {
        readable = false;
        return;
      }
      value = *number;
    }
    set |= 1u << (letter - 'A');
    values[static_cast<size_t>(letter - 'A')] = value;
    text.remove_prefix(used);
  }
}

bool CommandWords::OnlyFrom(std::string_view letters) const {
  uint32_t known = 0;
  for (const char c : letters) known |= 1u << (c - 'A');
  return readable && (set & ~known) == 0;
}

std::string_view WordsOf(std::string_view line) {
  const std::string_view code = line.substr(0, line.find(';'));
  const size_t digits = code.find_first_not_of("0123456789", 1);
  return digits == std::string_view::npos ? std::string_view{} : code.substr(digits);
}

}  // namespace traverse::gcode
