// Links of a file that show how travel between paths of the part is written.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_PART_LINKS_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_PART_LINKS_H_

#include <cstdint>

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// Whether the link to `block` leads from one path of the part itself to another: neither is printed
// by a script or on a tower.
bool LeadsWithinPart(const GcodeFile& file, uint32_t block);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_PART_LINKS_H_
