// Chooses the order of each layer of a file and puts the file together.
//
// Each layer has a few orders to choose from, among them the file's own. The travel to the next
// layer starts where a layer ends, so the choices depend on each other: the best sequence of them
// is taken (choice_row.h).
//
// Writes and measures O(layers) layers and travel moves between layers.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_CHOICE_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_CHOICE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "client/gcode/choose/chosen_layers.h"
#include "client/gcode/choose/layer_column.h"
#include "client/gcode/choose/merged_orders.h"
#include "client/gcode/choose/object_orders.h"
#include "client/gcode/choose/rows/island_rests.h"
#include "client/gcode/choose/rows/rested_row.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/plan/head_room.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"

namespace traverse::gcode {

// Chooses among the file's order and what is made of the one found (merged_orders.h), by the rules
// of choice_row.h: the least estimated time with no more travel across visible walls.
//
// The result does not depend on the number of threads.
class LayerChooser {
 public:
  // Writes and measures the orders to choose from. `file` and `found` outlive the chooser;
  // `found` is empty, or has all layers.
  LayerChooser(const GcodeFile& file, const FileOrder& found, const ChoiceOptions& options);
  LayerChooser(const LayerChooser&) = delete;
  LayerChooser& operator=(const LayerChooser&) = delete;

  // The best choice that is not ruled out.
  ChosenLayers Choose();

  // Rules out the link in line `line`, from 0, of the paths of `layer` as last chosen, and adds
  // the same order without it (order_repair.h). False if that is the file's own choice,
  // which always stays possible.
  bool RuleOutLink(size_t layer, size_t line);

  // The same for that the path in line `line` comes before the one in line `before`.
  bool RuleOutOrder(size_t layer, size_t line, size_t before);

  // The same for how the path in that line is placed. False if it is as in the file.
  bool RuleOutPath(size_t layer, size_t line);

  // The same for the travel to `layer` from the layer before: adds what begins or ends as sliced.
  bool RuleOutTravel(size_t layer);

  // Rules out that loops of `layer` begin elsewhere than in the file or, if none chosen last does,
  // that its paths are turned round. Adds the same order without that. False if all paths are as
  // in the file.
  bool RuleOutStarts(size_t layer);

  // Rules out all orders of layer `layer` but the file's; false if that was chosen last.
  bool RuleOutAll(size_t layer);

  // From now on the whole file must have `crossings` fewer moves across visible walls.
  void Tighten(int64_t crossings) { fewer_crossings_ += crossings; }

  // What Policy::kFast would save within layers (fast_forecast.h), in seconds.
  double SecondsSavedByFast() const;

  // True if an order found for `layer` is ruled out and the last choice was the file's order.
  bool IsGivenUp(size_t layer) const {
    return columns_[layer].chosen == 0 && columns_[layer].refusals.any;
  }

 private:
  std::vector<size_t> All() const;
  void ForEachLayer(const std::vector<size_t>& layers, const std::function<void(size_t)>& work);
  void ChooseRow();
  void TakeBestRow();
  MergeRules RulesOf(size_t layer, bool with_freedom = false) const;
  bool AnyFound(size_t layer) const;
  void KickChosen();
  bool SpareRetractions();
  bool AddWhere(const std::function<bool(size_t)>& where, const std::function<void(size_t)>& add);
  void Repair();
  void AddRepaired(size_t layer);
  void AddSparing(size_t layer);
  void FillColumn(size_t layer);
  void AddMerged(size_t layer, const MergeRules& rules, LayerColumn& column);
  bool AddPastObstacles(size_t layer);
  void FillTravels(size_t layer);
  void AddRested();
  TurnedLayer TurnsOf(size_t layer);
  void AddTurned(size_t layer, const IslandTurns& turns, size_t turn);
  ChosenLayers Write() const;

  const GcodeFile& file_;
  const FileOrder& found_;
  const ChoiceOptions options_;
  const RetractionHabit habit_;
  const LinkDonors donors_;
  const HeadRoom room_;
  IslandRests rests_;
  const std::vector<TravelModel> travel_;  // [layer]
  const ColumnFiller filler_;
  const ObjectOrders objects_;
  std::vector<LayerColumn> columns_;  // [layer]
  int64_t fewer_crossings_ = 0;
  bool polished_ = false;  // what was chosen first
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_CHOICE_H_
