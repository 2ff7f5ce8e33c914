// Decides in which order each layer of a file is done, and puts the file together.
//
// For each layer there are a few orders to choose from, that of the file among them. Where a layer
// ends is where the way to the next one begins, so that the choices hang together: the best row of
// them is taken (choice_row.h).
//
// O(layers * tries^2) ways between layers and O(layers * tries) layers are written and measured.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_CHOICE_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_CHOICE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/gcode/choose/order_polish.h"
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
  FileOrder orders;                 // [layer], empty for that of the file
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
  Allowance allow = {};
  int threads = 1;
  double min_revisit_seconds = 0;  // see revisits.h

  // Set: what is found is made better by small changes, for so long.
  std::optional<PolishLimit> polish = {};
};

// Chooses among the order of the file and those of `tries`, each made better by runs of the others
// (merged_orders.h), by the rules of choice_row.h: for the least estimated time, with no more ways
// across visible walls.
//
// The result does not depend on the number of threads.
class LayerChooser {
 public:
  // Writes and measures what there is to choose from. `file` and `tries` outlive the chooser.
  LayerChooser(const GcodeFile& file, const std::vector<FileOrder>& tries,
               const ChoiceOptions& options);
  ~LayerChooser();

  // The best of what is not ruled out.
  ChosenLayers Choose();

  // What was chosen last for the paths of `layer` is not chosen again, nor, if `way`, its way from
  // the layer before; false if that is how the file has it, which is always there to be chosen.
  bool RuleOut(size_t layer, bool way);

  // Of layer `layer` nothing but the order of the file is chosen from now on; false if it was.
  bool RuleOutAll(size_t layer);

  // From now on the whole file has `crossings` ways across visible walls fewer than it may have.
  void Tighten(int64_t crossings);

  // Something that was found for `layer` is ruled out, and the order of the file was chosen last.
  bool IsGivenUp(size_t layer) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_CHOICE_H_
