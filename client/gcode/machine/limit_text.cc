#include "client/gcode/machine/limit_text.h"

#include "absl/strings/str_cat.h"

namespace traverse::gcode {

absl::Status LimitFault(const std::string& name, int line, const std::string& what) {
  const std::string place = line > 0 ? absl::StrCat(":", line) : "";
  return absl::InvalidArgumentError(absl::StrCat(name, place, ": ", what));
}

}  // namespace traverse::gcode
