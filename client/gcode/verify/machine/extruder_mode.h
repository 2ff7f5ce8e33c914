// How the E words of a file count that does not say so.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_EXTRUDER_MODE_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_EXTRUDER_MODE_H_

#include <string_view>

namespace traverse::gcode {

// True if the E words of the first moves in the plane hardly add up to a register, and no line says
// how they count: then they count from the move before.
bool CountsFromTheMoveBefore(std::string_view text);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MACHINE_EXTRUDER_MODE_H_
