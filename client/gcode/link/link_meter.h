// How long a composed link takes between the two paths that it joins: line by line, as it would be
// measured if it were printed.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_LINK_METER_H_
#define TRAVERSE_CLIENT_GCODE_LINK_LINK_METER_H_

#include "client/gcode/link/new_link.h"
#include "client/gcode/link/path_ends.h"
#include "client/gcode/measure/print_meter.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/part_start.h"

namespace traverse::gcode {

// The seconds of `link` between two paths: what these take with it, less what they take each alone,
// from standstill to standstill. Below 0 if the link is shorter than what they would lose by stops.
// The machine is at `at` behind `from`.
double LinkSeconds(const GcodeFile& file, const PathEnds& from, const MachineState& at,
                   const NewLink& link, const PathEnds& to);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_LINK_METER_H_
