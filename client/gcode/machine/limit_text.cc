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

}  // namespace traverse::gcode
