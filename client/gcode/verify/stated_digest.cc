#include "client/gcode/verify/stated_digest.h"

#include <cstddef>
#include <string>

#include "client/files/md5.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {

bool HasRightMd5(std::string_view text) {
  constexpr std::string_view kBefore = "; MD5:";
  const size_t end = text.find('\n');
  if (!Begins(text, kBefore) || end == std::string_view::npos) return false;
  const std::string_view stated = TrimLine(text.substr(kBefore.size(), end - kBefore.size()));
  const std::string is = Md5Hex(text.substr(end + 1));
  return !is.empty() && EqualsInAnyCase(stated, is);
}

}  // namespace traverse::gcode
