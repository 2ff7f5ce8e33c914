// Moves that continue along a closed path after its end, without filament: CuraEngine wipes its
// outer walls so. They belong to the end of a path, wherever that end is.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_GOING_ON_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_GOING_ON_H_

#include <cstdint>
#include <optional>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/write/link.h"

namespace traverse::gcode {

// The move that continues along block `block`, as in the file; unset for most blocks.
std::optional<LinkStep> ReadGoingOn(const GcodeFile& file, uint32_t block);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_GOING_ON_H_
