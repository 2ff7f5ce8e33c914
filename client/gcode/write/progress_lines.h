// The lines of a layer that say how far the print is: M73 and others (machine/progress_line.h).
//
// They keep their sequence, and stand where as large a share of the layer's time is over as in the
// file: before paths, or between the segments of long ones. None passes what nothing crosses: these
// lines stay on their side of it, and those amid it stay there.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_PROGRESS_LINES_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_PROGRESS_LINES_H_

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// Appends `bare` to `out`, with the lines of `layer` inserted: the text of the layer's paths in
// some order, from `start` on. `marks` are where in it each path begins and ends, and become the
// same in `out`. `moved`: objects of the layer have changed places, so that the lines between them
// go through the whole layer.
void InsertProgressLines(const GcodeFile& file, const Layer& layer, bool moved,
                         std::string_view bare, const PartStart& start, std::vector<size_t>& marks,
                         std::string& out);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_PROGRESS_LINES_H_
