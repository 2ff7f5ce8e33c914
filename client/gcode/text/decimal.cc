#include "client/gcode/text/decimal.h"

#include <algorithm>
#include <cstddef>

namespace traverse::gcode {

std::optional<Decimal> ParseDecimal(const char** text, const char* end) {
  const char* p = *text;
  bool negative = false;
  if (p < end && (*p == '-' || *p == '+')) negative = *p++ == '-';
  bool any = false;
  Decimal value = 0;
  for (; p < end && IsDigit(*p); ++p) {
    any = true;
    value = value * 10 + (*p - '0');
    if (value > kDecimalMax / kDecimalOne) return std::nullopt;
  }
  value *= kDecimalOne;
  if (p < end && *p == '.') {
    ++p;
    // Behind nine decimals nothing is left of the unit.
    for (Decimal unit = kDecimalOne / 10; p < end && IsDigit(*p); ++p, unit /= 10) {
      any = true;
      value += (*p - '0') * unit;
    }
  }
  if (!any) return std::nullopt;
  *text = p;
  return negative ? -value : value;
}

std::optional<double> LeadingNumber(std::string_view text) {
  const char* p = text.data();
  const std::optional<Decimal> number = ParseDecimal(&p, text.data() + text.size());
  if (!number) return std::nullopt;
  return ToDouble(*number);
}

void AppendDecimal(Decimal value, NumberStyle style, std::string& out) {
  if (value < 0) out.push_back('-');
  uint64_t left =
      value < 0 ? uint64_t{0} - static_cast<uint64_t>(value) : static_cast<uint64_t>(value);
  char digits[20];
  char* const end = digits + sizeof(digits);
  char* const point = end - 9;  // behind it are the decimals
  char* first = end;
  for (; left > 0 || first > point; left /= 10) *--first = static_cast<char>('0' + left % 10);
  char* last = end;
  while (last > point && last[-1] == '0') --last;

  if (first == point && (style.leading_zero || last == point)) out.push_back('0');
  out.append(first, point);
  const auto decimals = static_cast<int>(last - point);
  const int written = std::max(decimals, style.fixed_decimals);
  if (written <= 0) return;
  out.push_back('.');
  out.append(point, last);
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
