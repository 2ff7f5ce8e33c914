#include "client/gcode/verify/machine/extruder_mode.h"

#include <charconv>
#include <cstddef>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {

bool CountsFromTheMoveBefore(std::string_view text) {
  for (const std::string_view mode : {"M82", "M83", "m82", "m83"}) {
    for (size_t at = text.find(mode); at != std::string_view::npos; at = text.find(mode, at + 1)) {
      size_t begin = at;
      while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
      if (begin == 0 || text[begin - 1] == '\n') return false;
    }
  }
  double last = 0;
  int rises = 0;
  int falls = 0;
  while (!text.empty() && rises + falls < 200) {
    std::string_view line = TakeLine(text);
    line = TrimLine(line.substr(0, line.find(';')));
    const size_t e = line.find_first_of("Ee");
    if (e == std::string_view::npos || UpperCase(line[0]) != 'G') continue;
    double value = 0;
    std::from_chars(line.data() + e + 1, line.data() + line.size(), value);
    const bool sets = line.substr(1, 2) == "92";
    if (!sets && line.find_first_of("XxYy") == std::string_view::npos) continue;
    if (!sets) ++(value <= last ? falls : rises);
    last = value;
  }
  return falls * 4 > rises;
}

}  // namespace traverse::gcode
