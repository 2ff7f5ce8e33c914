#include "client/gcode/read/custom_gcode.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include "client/gcode/text/lexer.h"
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
  return setting == "start_gcode" || setting == "end_gcode" || setting.starts_with("machine_");
}

}  // namespace

std::optional<std::vector<std::string_view>> SettingsThatAdd(std::string_view text,
                                                             std::string_view line_added) {
  const std::string_view command = line_added.substr(0, line_added.find_first_of(" \t;"));
  if (command.empty()) return std::nullopt;
  constexpr std::string_view kEnd = "_gcode = ";
  std::vector<std::string_view> with_line;
  std::vector<std::string_view> with_command;
  bool stated = false;
  for (Offset next = 0; next < text.size();) {
    const Line line = LineAt(text, next);
    next = line.next;
    const std::string_view comment = line.Text(text);
    if (!comment.starts_with(";")) continue;
    const size_t at = comment.find(kEnd);
    if (at == comment.npos) continue;
    const std::string_view name = TrimBlanks(comment.substr(1, at + kEnd.find(' ') - 1));
    if (!std::all_of(name.begin(), name.end(), IsOfWord)) continue;
    stated = true;
    const std::string_view value = comment.substr(at + kEnd.size());
    if (IsOfStartOrEnd(name) || !HasCommand(value, command)) continue;
    (HasCommand(value, line_added) ? with_line : with_command).push_back(name);
  }
  if (!stated) return std::nullopt;
  return with_line.empty() ? with_command : with_line;
}

}  // namespace traverse::gcode
