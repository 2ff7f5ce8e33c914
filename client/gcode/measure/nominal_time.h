// The time of a move at the speed that it states.
//
// Cooling is compared by it: it is the same in every model of a machine, and what accelerations add
// is much the same in each order of the same paths.

#ifndef TRAVERSE_CLIENT_GCODE_MEASURE_NOMINAL_TIME_H_
#define TRAVERSE_CLIENT_GCODE_MEASURE_NOMINAL_TIME_H_

#include "client/gcode/machine/interpreter.h"
#include "client/gcode/machine/machine_profile.h"

namespace traverse::gcode {

// `state` is how the machine is behind `step`. Includes the dwell of a G4. 0 for what moves nothing
// or has no speed.
double NominalSeconds(const Step& step, const MachineState& state, const MachineProfile& profile);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MEASURE_NOMINAL_TIME_H_
