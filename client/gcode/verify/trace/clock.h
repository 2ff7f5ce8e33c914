// The time of a print if every move is as fast as it states, and every dwell as long.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_CLOCK_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_CLOCK_H_

#include "client/gcode/verify/machine/verify_machine.h"

namespace traverse::gcode {

// How far `motion` goes in the plane, along its arc, in its own units.
double FlatLength(const Motion& motion);

// That of a line that `machine` has just done. Retractions by the firmware take no time.
double SecondsOf(const VerifyLine& line, const VerifyMachine& machine);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_CLOCK_H_
