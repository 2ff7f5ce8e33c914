#include "client/gcode/text/cura_settings.h"

namespace traverse::gcode {

std::string JoinedCuraSettings(std::string_view text) {
  constexpr std::string_view kMark = ";SETTING_3 ";
  std::string joined;
  for (size_t at = text.find(kMark); at != text.npos; at = text.find(kMark, at)) {
    at += kMark.size();
    joined += text.substr(at, text.find_first_of("\r\n", at) - at);
  }
  return joined;
}

}  // namespace traverse::gcode
