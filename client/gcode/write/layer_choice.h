// Decides in which order each layer of a file is done, and puts the file together.
//
// For each layer there are a few orders to choose from, that of the file among them. Where a layer
// ends is where the way to the next one begins, so that the choices hang together: the best row of
// them is a shortest path through a graph with a column for each layer, whose edges are the ways
// between layers, written and measured. O(layers * tries^2) ways and O(layers * tries) layers are
// written.

#ifndef TRAVERSE_CLIENT_GCODE_WRITE_LAYER_CHOICE_H_
#define TRAVERSE_CLIENT_GCODE_WRITE_LAYER_CHOICE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "client/gcode/measure/print_totals.h"
#include "client/gcode/plan/policy.h"
#include "client/gcode/write/layer_writer.h"

namespace traverse::gcode {

// One order for each layer of a file; empty for that of the file.
using FileOrder = std::vector<LayerOrder>;

// A layer as it was written. `paths` is empty if they are as in the file.
struct LayerText {
  std::string way;
  std::string paths;
};

// The layers of a file, each in the order chosen for it.
struct ChosenLayers {
  std::vector<LayerText> texts;     // [layer]
  PartStart behind;                 // the machine behind the last one
  std::vector<PrintTotals> given;   // [layer], with the way to it, in the file's order
  std::vector<PrintTotals> totals;  // [layer], as chosen
  int64_t changed = 0;              // layers in another order than the file's

  // Appends all layers, from the first path to the end of the last one.
  void AppendTo(const GcodeFile& file, std::string& text) const;
};

struct ChoiceOptions {
  Policy policy = Policy::kSafe;
  Crossings crossings = Crossings::kKeep;
  int threads = 1;
};

// Chooses among the order of the file and those of `tries` for the least estimated time; under
// Crossings::kFewer a crossing counts as time. No layer has more ways across visible walls than in
// the file but under Crossings::kAny, and under Policy::kSafe none has more travel, nor more such
// ways with an open nozzle, neither within nor together with the way to it. The result does not
// depend on `threads`.
ChosenLayers ChooseLayers(const GcodeFile& file, const std::vector<FileOrder>& tries,
                          const ChoiceOptions& options);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_WRITE_LAYER_CHOICE_H_
