#include "client/gcode/text/decimal.h"

#include <algorithm>
#include <cstddef>

namespace traverse::gcode {
namespace {

constexpr Decimal kPowers[kDecimalDigits + 1] = {
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

// A number of any length from its first digit or point on; see ParseDecimal.
std::optional<Decimal> ParseLong(const char** text, const char* end) {
  const char* p = *text;
  const char* const first = p;
  Decimal whole = 0;
  for (; p < end && IsDigit(*p); ++p) {
    whole = whole * 10 + (*p - '0');
    if (whole > kDecimalMax / kDecimalOne) return std::nullopt;
  }
  int digits = static_cast<int>(p - first);
  Decimal fraction = 0;
  if (p < end && *p == '.') {
    const char* const point = p++;
    int decimals = 0;
    for (; p < end && IsDigit(*p); ++p) {
      if (decimals == kDecimalDigits) continue;
      fraction = fraction * 10 + (*p - '0');
      ++decimals;
    }
    fraction *= kPowers[kDecimalDigits - decimals];
    digits += static_cast<int>(p - point) - 1;
  }
  if (digits == 0) return std::nullopt;
  *text = p;
  return whole * kDecimalOne + fraction;
}

}  // namespace

std::optional<Decimal> ParseDecimal(const char** text, const char* end) {
  const char* p = *text;
  bool negative = false;
  if (p < end && (*p == '-' || *p == '+')) negative = *p++ == '-';
  const char* const first = p;
  // Numbers of at most nine digits on either side of the point fit as they come.
  constexpr int kMostDigits = 9;
  uint64_t value = 0;
  for (; p < end && IsDigit(*p) && p - first <= kMostDigits; ++p) {
    value = value * 10 + static_cast<uint64_t>(*p - '0');
  }
  int digits = static_cast<int>(p - first);
  bool is_long = digits > kMostDigits;
  int decimals = 0;
  if (p < end && *p == '.') {
    const char* const behind_point = ++p;
    for (; p < end && IsDigit(*p) && p - behind_point <= kMostDigits; ++p) {
      value = value * 10 + static_cast<uint64_t>(*p - '0');
    }
    decimals = static_cast<int>(p - behind_point);
    is_long = is_long || decimals > kMostDigits;
    digits += decimals;
  }
  if (digits == 0) return std::nullopt;
  Decimal read = 0;
  if (is_long) {
    p = first;
    const std::optional<Decimal> long_number = ParseLong(&p, end);
    if (!long_number) return std::nullopt;
    read = *long_number;
  } else {
    read = static_cast<Decimal>(value) * kPowers[kDecimalDigits - decimals];
  }
  *text = p;
  return negative ? -read : read;
}

void AppendDecimal(Decimal value, NumberStyle style, std::string& out) {
  if (value < 0) out.push_back('-');
  const uint64_t magnitude =
      value < 0 ? uint64_t{0} - static_cast<uint64_t>(value) : static_cast<uint64_t>(value);
  uint64_t whole = magnitude / static_cast<uint64_t>(kDecimalOne);
  uint64_t fraction = magnitude % static_cast<uint64_t>(kDecimalOne);

  char buffer[20];
  char* const buffer_end = buffer + sizeof(buffer);
  char* digit = buffer_end;
  for (; whole > 0; whole /= 10) *--digit = static_cast<char>('0' + whole % 10);
  if (digit == buffer_end && (style.leading_zero || fraction == 0)) *--digit = '0';
  out.append(digit, static_cast<size_t>(buffer_end - digit));

  int decimals = kDecimalDigits;
  while (decimals > 0 && fraction % 10 == 0) {
    fraction /= 10;
    --decimals;
  }
  const int written = std::max(decimals, style.fixed_decimals);
  if (written <= 0) return;
  out.push_back('.');
  digit = buffer_end;
  for (int i = 0; i < decimals; ++i, fraction /= 10) {
    *--digit = static_cast<char>('0' + fraction % 10);
  }
  out.append(digit, static_cast<size_t>(buffer_end - digit));
  out.append(static_cast<size_t>(written - decimals), '0');
}

void NumberStyleLearner::Show(std::string_view token) {
  ++seen_;
  const size_t point = token.find('.');
  if (point != std::string_view::npos && token.back() == '0') {
    ++padded_;
    decimals_ = std::max(decimals_, static_cast<int>(token.size() - point - 1));
  }
  const size_t first = token.find_first_not_of("+-");
  bare_point_ = bare_point_ || (first != std::string_view::npos && token[first] == '.');
}

NumberStyle NumberStyleLearner::Learned() const {
  NumberStyle style;
  // With a fixed number of decimals one token in ten ends in a zero; start scripts hold a few more.
  if (padded_ * 20 > seen_) style.fixed_decimals = decimals_;
  style.leading_zero = !bare_point_;
  return style;
}

}  // namespace traverse::gcode
