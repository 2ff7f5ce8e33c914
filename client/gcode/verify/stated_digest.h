// The digest that the first line of a text may state of the rest.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_STATED_DIGEST_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_STATED_DIGEST_H_

#include <string_view>

namespace traverse::gcode {

// True if the first line of `text` is `; MD5:` and the 32 hexadecimal digits of the MD5 of all that
// follows it. Such lines are equal in two texts, whatever these are; a wrong one is a comment.
bool HasRightMd5(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_STATED_DIGEST_H_
