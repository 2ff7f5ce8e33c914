// Decides in which order each layer of a file is done, and puts the file together.
//
// For each layer there are a few orders to choose from, that of the file among them. Where a layer
// ends is where the way to the next one begins, so that the choices hang together: the best row of
// them is a shortest path through a graph with a column for each layer, whose edges are the ways
// between layers, written and measured. O(layers * tries^2) ways and O(layers * tries) layers are
// written.

#ifndef TRAVERSE_CLIENT_GCODE_LAYER_CHOICE_H_
#define TRAVERSE_CLIENT_GCODE_LAYER_CHOICE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "client/gcode/layer_writer.h"
#include "client/gcode/policy.h"
#include "client/gcode/print_totals.h"

namespace traverse::gcode {

// One order for each layer of a file; empty for that of the file.
using FileOrder = std::vector<LayerOrder>;

// The layers of a file, written one behind the other.
struct ChosenLayers {
  std::string text;  // from the first path to the end of the last one
  PartStart behind;
  std::vector<PrintTotals> totals;  // [layer], with the way to it
  int64_t changed = 0;              // layers in another order than the file's
};

// Chooses among the order of the file and those of `tries` for the least estimated time. Under
// Policy::kSafe no layer has more travel than in the file, neither within nor together with the way
// to it. The result does not depend on `threads`.
ChosenLayers ChooseLayers(const GcodeFile& file, const std::vector<FileOrder>& tries, Policy policy,
                          int threads);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LAYER_CHOICE_H_
