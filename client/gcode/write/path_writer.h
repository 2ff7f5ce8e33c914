// Writes paths.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_PATH_WRITER_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_PATH_WRITER_H_

#include "client/gcode/model/placed_path.h"
#include "client/gcode/write/gcode_out.h"

namespace traverse::gcode {

// Appends `path` without its lines of progress; `out` is where it begins, with its state and feed
// rate set.
void WritePath(const PlacedPath& path, GcodeOut& out);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_PATH_WRITER_H_
