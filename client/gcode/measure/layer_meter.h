// Measures the layers of a sliced file, and others put in their places.

#ifndef TRAVERSE_CLIENT_GCODE_MEASURE_LAYER_METER_H_
#define TRAVERSE_CLIENT_GCODE_MEASURE_LAYER_METER_H_

#include <cstdint>
#include <string_view>
#include <vector>

#include "client/gcode/measure/print_totals.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/visible_walls.h"

namespace traverse::gcode {

// Where a part of a file begins: the machine, and the state that holds.
struct PartStart {
  MachineState machine;
  PrintState state;
};

// What the lines `text` amount to, from standstill to standstill. Ways across `walls` are counted
// unless those are null.
PrintTotals Measure(const GcodeFile& file, std::string_view text, const PartStart& start,
                    const VisibleWalls* walls = nullptr);

// How the machine is behind block `block`.
PartStart StartBehind(const GcodeFile& file, const Block& block);

// The paths of a layer as they are in the file, and the ways between them.
PrintTotals MeasurePaths(const GcodeFile& file, const Layer& layer, const VisibleWalls& walls);

// The way to the first path of `layer`, from the end of the layer before; nothing for the first.
PrintTotals MeasureWay(const GcodeFile& file, const Layer& layer, const VisibleWalls& walls);

// The link before block `block`, whichever it is, as it is in the file. REQUIRES: block > 0.
PrintTotals MeasureLink(const GcodeFile& file, uint32_t block, const VisibleWalls& walls);

// [layer]: its paths and the way to it, with a standstill between the two. Uses `threads` threads;
// the result does not depend on them.
std::vector<PrintTotals> MeasureLayers(const GcodeFile& file, int threads = 1);

PrintTotals Sum(const std::vector<PrintTotals>& totals);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MEASURE_LAYER_METER_H_
