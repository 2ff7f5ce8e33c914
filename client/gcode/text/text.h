// Small helpers on std::string_view, which Debian 12's absl/strings does not take.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_TEXT_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_TEXT_H_

#include <algorithm>
#include <string_view>

namespace traverse::gcode {

// Of letters of ASCII; others stay.
inline char Capital(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

inline bool StartsWithInAnyCase(std::string_view text, std::string_view prefix) {
  return text.size() >= prefix.size() &&
         std::equal(prefix.begin(), prefix.end(), text.begin(),
                    [](char x, char y) { return Capital(x) == Capital(y); });
}

inline std::string_view TrimBlanks(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// The next of the blank-separated words, behind which `rest` goes on; empty at the end.
inline std::string_view NextWord(std::string_view& rest) {
  rest = TrimBlanks(rest);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
  rest.remove_prefix(word.size());
  return word;
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_TEXT_H_
