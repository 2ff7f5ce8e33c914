#include "client/gcode/machine/progress_line.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>

#include "client/gcode/text/decimal.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// In small letters, with blanks for what joins words, and one at each end.
std::string WordsIn(std::string_view text) {
  std::string words(1, ' ');
  for (const char c : text) {
    const bool joins = c == '_' || c == '-' || c == '\t' || c == '"' || c == ':' || c == ',';
    words.push_back(joins ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  words.push_back(' ');
  return words;
}

bool HasAny(std::string_view words, std::initializer_list<std::string_view> of) {
  return std::any_of(of.begin(), of.end(), [words](std::string_view word) {
    return words.find(word) != std::string_view::npos;
  });
}

// What follows the digit before `at`, but for blanks.
std::string_view Behind(std::string_view words, size_t at) {
  const size_t next = words.find_first_not_of(' ', at);
  return next == std::string_view::npos ? std::string_view() : words.substr(next);
}

// `33 %`, `12/220`, `12 of 220`.
bool HasShare(std::string_view words) {
  for (size_t at = words.find_first_of("0123456789"); at < words.size(); ++at) {
    if (!IsDigit(words[at]) || IsDigit(words[at + 1])) continue;
    std::string_view rest = Behind(words, at + 1);
    if (rest.starts_with("%")) return true;
    const size_t joint = rest.starts_with("/") ? 1 : rest.starts_with("of ") ? 3 : 0;
    rest = joint > 0 ? Behind(rest, joint) : std::string_view();
    if (!rest.empty() && IsDigit(rest[0])) return true;
  }
  return false;
}

}  // namespace

bool IsProgressComment(std::string_view comment) {
  const size_t mark = comment.find_first_of(":=");
  if (mark == std::string_view::npos) return false;
  const std::string_view value = TrimBlanks(comment.substr(mark + 1));
  if (value.empty() || !IsDigit(value[0])) return false;
  const std::string key = WordsIn(TrimBlanks(comment.substr(1, mark - 1)));
  return HasAny(key, {" elapsed ", " remaining ", " progress ", " printing time ", " time left ",
                      " layer num/total "});
}

bool IsProgressMessage(std::string_view message) {
  const std::string words = WordsIn(message);
  if (HasShare(words)) return true;
  const bool time = HasAny(words, {" left ", " remain ", " remaining ", " elapsed "});
  return time && std::any_of(words.begin(), words.end(), IsDigit);
}

bool IsProgressMacro(std::string_view line) {
  constexpr std::string_view kShow = "SET_DISPLAY_TEXT";
  return StartsWithInAnyCase(line, kShow) && line.size() > kShow.size() &&
         (line[kShow.size()] == ' ' || line[kShow.size()] == '\t') &&
         IsProgressMessage(line.substr(line.find('=') + 1));
}

}  // namespace traverse::gcode
