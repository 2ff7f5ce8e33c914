// Moves that go on along a closed path, behind its end and without filament: CuraEngine wipes its
// outer walls so. They are part of how a path ends, wherever it is made to end.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_GOING_ON_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_GOING_ON_H_

#include <cstdint>
#include <optional>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/write/link.h"

namespace traverse::gcode {

// The move that goes on along block `block`, as the file has it; nothing for most.
std::optional<LinkStep> ReadGoingOn(const GcodeFile& file, uint32_t block);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_GOING_ON_H_
