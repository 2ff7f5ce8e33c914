// What may be chosen of the layers of a file, and what was; and their text.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_CHOSEN_LAYERS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_CHOSEN_LAYERS_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/gcode/choose/orders/order_polish.h"
#include "client/gcode/choose/rows/island_rests.h"
#include "client/gcode/measure/print_totals.h"
#include "client/gcode/model/part_start.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/policy.h"

namespace traverse::gcode {

struct LayerColumn;
class HiddenMoves;

struct ChoiceOptions : Liberties {
  int threads = 1;

  // If set, small changes improve the orders found, within this limit, which takes about as long as
  // a search of the service. What ends it early ends nothing else.
  std::optional<PolishLimit> polish = {};

  // See HabitOfNewTravels.
  std::shared_ptr<const HiddenMoves> hidden = nullptr;
};

// One order for each layer of a file; empty for the file's own order.
using FileOrder = std::vector<LayerOrder>;

// What orders are searched for and chosen by, summed up for the file's own orders and for those
// chosen: within a layer the estimates of its travel moves, one by one, each with its retraction;
// the travel moves between layers as they were measured to choose among orders, with what scripts
// do there. No layer is measured for it, so beside the time of what is written it shows how true
// the estimates are.
struct Forecast {
  double given_seconds = 0;
  double seconds = 0;
};

// The shortest rest of an island that rests in the file, before and after.
struct RestTotals {
  double required_seconds = 0;  // that are enough; 0: no island must rest
  std::optional<LeastRest> given;
  std::optional<LeastRest> chosen;
};

// A layer as written. `paths` is empty if the paths are as in the file.
struct LayerText {
  std::string travel;
  std::string paths;
};

// The layers of a file, each in its chosen order.
struct ChosenLayers {
  std::vector<LayerText> texts;     // [layer], empty for the file's own order
  FileOrder orders;                 // [layer], empty for the file's own order
  PartStart behind;                 // the machine after the last layer
  std::vector<PrintTotals> given;   // [layer], with the travel to it, in the file's order
  std::vector<PrintTotals> totals;  // [layer], as chosen
  int64_t changed = 0;              // layers in another order than the file's
  std::vector<size_t> blocked;      // layers with orders found where something is in the way
  Forecast forecast;                // of all travel between paths
  RestTotals rest;                  // of islands

  // Appends all layers, from the first path to the end of the last one.
  void AppendTo(const GcodeFile& file, std::string& text) const;
};

// What was chosen of `columns`, one a layer, written and summed up. Of `rest` nothing is set. The
// result does not depend on the number of threads.
ChosenLayers WriteChosen(const GcodeFile& file, const std::vector<LayerColumn>& columns,
                         int threads);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_CHOSEN_LAYERS_H_
