// Puts a file together layer by layer, and decides which layers get their new order.

#ifndef TRAVERSE_CLIENT_GCODE_LAYER_CHOICE_H_
#define TRAVERSE_CLIENT_GCODE_LAYER_CHOICE_H_

#include <string>
#include <vector>

#include "client/gcode/layer_writer.h"
#include "client/gcode/policy.h"
#include "client/gcode/print_totals.h"

namespace traverse::gcode {

// The layers of a file, written one behind the other.
struct ChosenLayers {
  std::string text;  // from the first path to the end of the last one
  PartStart behind;
  Placement last;                   // the last path
  std::vector<PrintTotals> totals;  // [layer]
  int64_t changed = 0;              // layers in another order than the file's
};

// Writes each layer in `orders[layer]` (empty: the order of the file) if that meets the conditions
// of RewriteGcode, else in the order of the file. Where a layer meets them in neither order, for
// the one before now ends elsewhere, that one goes back to the order of the file.
// `given` is what the file's layers amount to.
ChosenLayers ChooseLayers(const GcodeFile& file, const std::vector<LayerOrder>& orders,
                          const std::vector<PrintTotals>& given, Policy policy);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LAYER_CHOICE_H_
