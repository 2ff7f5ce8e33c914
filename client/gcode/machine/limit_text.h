// What the readers of machine limits share: lines with numbers, faults with places, ranges of
// values.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_LIMIT_TEXT_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_LIMIT_TEXT_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "client/gcode/machine/machine_limits.h"
#include "client/gcode/text/lexer.h"

namespace traverse::gcode {

// An error of the line `line`, from 1, of the file `name`; 0: of all of it.
inline absl::Status LimitFault(const std::string& name, int line, const std::string& what) {
  const std::string place = line > 0 ? absl::StrCat(":", line) : "";
  return absl::InvalidArgumentError(absl::StrCat(name, place, ": ", what));
}

// Calls visit(line, number from 1) until that is a fault.
template <typename Visit>
absl::Status ForEachLine(std::string_view text, Visit visit) {
  int number = 0;
  for (Offset next = 0; next < text.size();) {
    const Line line = LineAt(text, next);
    next = line.next;
    if (absl::Status status = visit(line.Text(text), ++number); !status.ok()) return status;
  }
  return absl::OkStatus();
}

// The greatest limit, in any unit: beyond all machines, and far from where sums of squares are not
// finite.
inline constexpr double kGreatestLimit = 1e9;

// Which values a setting may have, and what others are.
struct Range {
  bool (*holds)(double value);
  const char* fault;
};
inline constexpr Range kAboveZero = {
    [](double value) { return value > 0 && value <= kGreatestLimit; },
    "not a number above 0 and up to 1e9"};
inline constexpr Range kFromZero = {
    [](double value) { return value >= 0 && value <= kGreatestLimit; },
    "not a number from 0 to 1e9"};
inline constexpr Range kRatio = {[](double value) { return value >= 0 && value < 1; },
                                 "not a number from 0 to below 1"};

using LimitField = std::optional<double> MachineLimits::*;

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_LIMIT_TEXT_H_
