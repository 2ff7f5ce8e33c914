#include "client/gcode/machine/limit_text.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace traverse::gcode {

absl::Status LimitFault(const std::string& where, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(where, ": ", what));
}

std::string LineOf(const std::string& name, int line) {
  return absl::StrFormat("%s:%d", name, line);
}

bool Holds(Range range, double value) {
  switch (range) {
    case Range::kAboveZero:
      return value > 0 && value <= kGreatestLimit;
    case Range::kFromZero:
      return value >= 0 && value <= kGreatestLimit;
    case Range::kRatio:
      return value >= 0 && value < 1;
  }
  return false;
}

const char* NameOf(Range range) {
  switch (range) {
    case Range::kAboveZero:
      return "not a number above 0 and up to 1e9";
    case Range::kFromZero:
      return "not a number from 0 to 1e9";
    case Range::kRatio:
      return "not a number from 0 to below 1";
  }
  return "";
}

}  // namespace traverse::gcode
