// Measures the layers of a sliced file, and others put in their places.

#ifndef TRAVERSE_CLIENT_GCODE_LAYER_METER_H_
#define TRAVERSE_CLIENT_GCODE_LAYER_METER_H_

#include <string_view>
#include <vector>

#include "client/gcode/gcode_file.h"
#include "client/gcode/print_totals.h"

namespace traverse::gcode {

// Where a part of a file begins: the machine, and the state that holds.
struct PartStart {
  MachineState machine;
  PrintState state;
};

// What the lines `text` amount to, from standstill to standstill.
PrintTotals Measure(const GcodeFile& file, std::string_view text, const PartStart& start);

// How the machine is behind block `block`.
PartStart StartBehind(const GcodeFile& file, const Block& block);

// [layer]: from the end of the layer before to the end of its last path. The first layer begins
// with its first path. Uses `threads` threads; the result does not depend on them.
std::vector<PrintTotals> MeasureLayers(const GcodeFile& file, int threads = 1);

PrintTotals Sum(const std::vector<PrintTotals>& totals);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LAYER_METER_H_
