// Text inside HTML and SVG.

#ifndef TRAVERSE_CLIENT_VIEW_DRAWING_MARKUP_H_
#define TRAVERSE_CLIENT_VIEW_DRAWING_MARKUP_H_

#include <string>
#include <string_view>

namespace traverse::view {

// `text` as content or between quotes: &, <, >, " and ' become references. Invalid UTF-8 and
// control characters become U+FFFD, because file names may have any bytes.
std::string EscapeMarkup(std::string_view text);

// `text` as valid UTF-8, with invalid parts replaced by U+FFFD.
std::string ValidUtf8(std::string_view text);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_DRAWING_MARKUP_H_
