// Prints links that the file does not have.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LINK_WRITER_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LINK_WRITER_H_

#include "client/gcode/link/new_link.h"
#include "client/gcode/write/gcode_out.h"

namespace traverse::gcode {

// Appends `link`, which begins where `out` ends.
void PrintLink(const NewLink& link, GcodeOut& out);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LINK_WRITER_H_
