// Where a part of a file begins.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_PART_START_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_PART_START_H_

#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// The machine and the print state there.
struct PartStart {
  MachineState machine;
  PrintState state;
};

// The state of the machine after block `block`.
PartStart StartBehind(const GcodeFile& file, const Block& block);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_PART_START_H_
