// The time of a move at the speed that it states.
//
// Cooling is compared by it: it is the same in every model of a machine, and what accelerations add
// is much the same in each order of the same paths.

#ifndef TRAVERSE_CLIENT_GCODE_MEASURE_NOMINAL_TIME_H_
#define TRAVERSE_CLIENT_GCODE_MEASURE_NOMINAL_TIME_H_

#include "client/gcode/machine/interpreter.h"

namespace traverse::gcode {

// `state` is how the machine is behind `step`: any move by G0 to G3, also one that stays where it
// is because of what else it does, along its arc; and a dwell. What G10 and G11 take only the
// machine knows: 0, as for all else.
double NominalSeconds(const Step& step, const MachineState& state);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MEASURE_NOMINAL_TIME_H_
