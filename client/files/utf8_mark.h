// The byte order mark of UTF-8, with which some editors begin a text.

#ifndef TRAVERSE_CLIENT_FILES_UTF8_MARK_H_
#define TRAVERSE_CLIENT_FILES_UTF8_MARK_H_

#include <string_view>

namespace traverse {

inline constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

inline std::string_view WithoutUtf8Mark(std::string_view text) {
  return text.starts_with(kUtf8Mark) ? text.substr(kUtf8Mark.size()) : text;
}

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_UTF8_MARK_H_
