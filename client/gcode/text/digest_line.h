// The first line of some files, `; MD5:` and 32 hexadecimal digits: the digest of all that follows
// it. Printers that look for it (Forge-X, bambufy) refuse a file that does not have this digest.

#ifndef TRAVERSE_CLIENT_GCODE_TEXT_DIGEST_LINE_H_
#define TRAVERSE_CLIENT_GCODE_TEXT_DIGEST_LINE_H_

#include <string>
#include <string_view>

namespace traverse::gcode {

// True if `text` begins with that line and has that digest.
bool StatesItsDigest(std::string_view text);

// Writes the digest that `text` has into its first line. REQUIRES: it stated its digest before it
// was changed behind that line.
void RenewDigest(std::string& text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_TEXT_DIGEST_LINE_H_
