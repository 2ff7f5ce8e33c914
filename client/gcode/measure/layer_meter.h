// Measures the layers of a sliced file, and others that replace them.

#ifndef TRAVERSE_CLIENT_GCODE_MEASURE_LAYER_METER_H_
#define TRAVERSE_CLIENT_GCODE_MEASURE_LAYER_METER_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "client/gcode/measure/print_totals.h"
#include "client/gcode/model/gcode_file.h"
#include "client/gcode/model/part_start.h"
#include "client/gcode/model/visible_walls.h"
#include "client/gcode/plan/head_room.h"

namespace traverse::gcode {

// Moments of a text: when the lines that begin at `offsets` or behind it are reached, in nominal
// seconds from its beginning.
struct TextMoments {
  std::vector<size_t> offsets;  // ascending
  std::vector<double> seconds;  // [offset], as measured
};

// Where in the text of a layer's paths (GcodeFile::PathsText) each path begins and ends.
std::vector<size_t> PathMarks(const GcodeFile& file, const Layer& layer);

// The totals of the lines `text`, from standstill to standstill. Counts travel moves across
// `walls`, and moves without filament that are not clear in `room`, unless these are null. Measures
// `moments` too, unless that is null.
PrintTotals Measure(const GcodeFile& file, std::string_view text, const PartStart& start,
                    const VisibleWalls* walls = nullptr, const Room* room = nullptr,
                    TextMoments* moments = nullptr);

// The nominal seconds of the lines `text`. Measures `moments`, unless that is null, and calls
// `visit`, if it is set, with each step and when it begins.
using VisitStep = std::function<void(const Step& step, double seconds)>;
double MeasureMoments(const GcodeFile& file, std::string_view text, const PartStart& start,
                      TextMoments* moments, const VisitStep& visit = {});

// The state of the machine where the file begins, as the printer takes the file's E.
PartStart StartOfFile(const GcodeFile& file);

// The paths of a layer as they are in the file, and the travel between them.
PrintTotals MeasurePaths(const GcodeFile& file, const Layer& layer, const VisibleWalls& walls,
                         TextMoments* moments = nullptr);

// The travel to the first path of `layer` from the end of the layer before; empty for the first.
PrintTotals MeasureTravel(const GcodeFile& file, const Layer& layer, const VisibleWalls& walls);

// Any link before block `block`, as it is in the file. REQUIRES: block > 0.
PrintTotals MeasureLink(const GcodeFile& file, uint32_t block, const VisibleWalls& walls);

// [layer]: its paths and the travel to it, with a standstill between the two. Uses `threads`
// threads; the result does not depend on their number.
std::vector<PrintTotals> MeasureLayers(const GcodeFile& file, int threads = 1);

PrintTotals Sum(const std::vector<PrintTotals>& totals);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MEASURE_LAYER_METER_H_
