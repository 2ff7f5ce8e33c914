// Numbers of G-code, kept exactly.
//
// A file is text: if a rewriter's rounding loses an extrusion of 0.00001 mm, a segment is lost. So
// numbers are integers in units of 1e-9 (of mm, inch, mm/min, whatever the word means), and
// arithmetic with them is exact. Programs that write every digit of a double write more decimals;
// these, a thousandth of what any printer keeps, are cut off.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_DECIMAL_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_DECIMAL_H_

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace traverse::gcode {

// A number in units of 1e-9.
using Decimal = int64_t;

inline constexpr Decimal kDecimalOne = 1'000'000'000;

// Larger numbers are refused, so that sums and differences of a few cannot overflow.
inline constexpr Decimal kDecimalMax = 1'000'000'000 * kDecimalOne;

inline bool IsDigit(char c) { return c >= '0' && c <= '9'; }

inline double ToDouble(Decimal value) { return static_cast<double>(value) * 1e-9; }

// Reads a number as G-code writes it (`-.8`, `12`, `9000.000`, `+1.5`) at `*text`, and moves
// `*text` past it. Decimals beyond nine are cut off. Unset if there is no number, or if it is
// beyond kDecimalMax.
std::optional<Decimal> ParseDecimal(const char** text, const char* end);

// The number with which `text` begins, as ParseDecimal reads it.
std::optional<double> LeadingNumber(std::string_view text);

// How a file writes its numbers.
struct NumberStyle {
  // Number of decimals always written, as in `E1.00000`; -1: trailing zeros are dropped.
  int fixed_decimals = -1;

  // `0.8` and not `.8`.
  bool leading_zero = true;
};

// Appends `value`, never rounded: decimals beyond `fixed_decimals` are written unless they are
// zero.
void AppendDecimal(Decimal value, NumberStyle style, std::string& out);

// Learns a style from the numbers it is shown.
class NumberStyleLearner {
 public:
  // `token` is a number as read by ParseDecimal.
  void Show(std::string_view token);
  NumberStyle Learned() const;

 private:
  int seen_ = 0;
  int padded_ = 0;           // tokens whose decimals end in a zero
  int decimals_ = 0;         // most decimals of a padded token
  bool bare_point_ = false;  // a token begins with its point
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_DECIMAL_H_
