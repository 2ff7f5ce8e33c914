#include "client/gcode/read/custom_gcode.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

bool IsOfWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// `command` begins one of the lines of `value`, which an `n` behind a backslash divides.
bool HasCommand(std::string_view value, std::string_view command) {
  for (size_t at = value.find(command); at != value.npos; at = value.find(command, at + 1)) {
    const size_t end = at + command.size();
    if (end < value.size() && IsOfWord(value[end])) continue;
    const std::string_view before = value.substr(0, at);
    if (before.empty() || before.ends_with("\\n") || !IsOfWord(before.back())) return true;
  }
  return false;
}

bool IsOfStartOrEnd(std::string_view setting) {
  return setting == "start_gcode" || setting == "end_gcode" || StartsWith(setting, "machine_");
}

}  // namespace

std::optional<std::string_view> SettingThatAdds(std::string_view text, std::string_view command) {
  constexpr std::string_view kEnd = "_gcode = ";
  bool stated = false;
  for (size_t at = text.find(kEnd); at != text.npos; at = text.find(kEnd, at + 1)) {
    const size_t begin = text.substr(0, at).rfind('\n') + 1;  // 0 if there is none
    if (text[begin] != ';') continue;
    const size_t name_end = at + kEnd.find(' ');
    const std::string_view name = TrimBlanks(text.substr(begin + 1, name_end - begin - 1));
    if (!std::all_of(name.begin(), name.end(), IsOfWord)) continue;
    stated = true;
    const size_t value = at + kEnd.size();
    const size_t value_end = std::min(text.find('\n', value), text.size());
    if (!IsOfStartOrEnd(name) && HasCommand(text.substr(value, value_end - value), command)) {
      return name;
    }
  }
  return stated ? std::optional<std::string_view>("") : std::nullopt;
}

}  // namespace traverse::gcode
