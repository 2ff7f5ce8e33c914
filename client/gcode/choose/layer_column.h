// The orders that a layer has to choose from, as written.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_COLUMN_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_COLUMN_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "client/gcode/choose/orders/known_travels.h"
#include "client/gcode/choose/refusals.h"
#include "client/gcode/choose/rows/choice_row.h"
#include "client/gcode/choose/rows/island_rests.h"
#include "client/gcode/link/link_donors.h"
#include "client/gcode/plan/travel_model.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/gcode/write/layer_writer.h"

namespace traverse::gcode {

// One order of a layer.
struct LayerChoice {
  LayerOrder order;
  const LayerWriter* writer = nullptr;
  PartStart start;  // how it begins and ends as it was written to be measured
  PartStart behind;
  bool as_sliced = false;  // as it is in the file
  bool resets_e = false;   // the register is set on the way, and does not count through
  IslandTimes times;
};

// A layer and what it may be. choices[0] is the order of the file.
struct LayerColumn {
  std::unique_ptr<const LayerWriter> writer;
  std::unique_ptr<const LayerWriter> plain;  // which spares no walls; null if not needed
  std::vector<LayerChoice> choices;
  ChoiceColumn totals;
  bool blocked = false;  // in the order that was found, something stands in the way
  uint32_t chosen = 0;
  double given_travel_seconds = 0;    // nominal, to the layer in the file
  std::vector<double> given_moments;  // when each path begins and ends there
  std::vector<bool> measured;         // [as totals.travels]
  size_t travels_to = 0;              // choices that these lead to
  Refusals refusals;
  std::vector<size_t> ends;                     // see PlaceOfLine
  std::unique_ptr<KnownTravels> known_travels;  // of `writer`; null until they are asked for

  const LayerOrder& given_order() const { return choices[0].order; }
  const LayerChoice& Chosen() const { return choices[chosen]; }

  KnownTravels& travels() {
    if (known_travels == nullptr) known_travels = std::make_unique<KnownTravels>(*writer);
    return *known_travels;
  }

  void Take(uint32_t choice) {
    chosen = choice;
    ends.clear();
  }
};

// The place whose path, or the link to it, has line `line`, from 0, of the paths of `column` as
// last chosen.
size_t PlaceOfLine(LayerColumn& column, size_t line);

// Writes and measures choices, and keeps none of the texts: those of all choices of a file are far
// more than the file, and to take that much memory costs more than to write one order of each layer
// again. Thread-safe.
class ColumnFiller {
 public:
  // All outlive the filler and the columns.
  ColumnFiller(const GcodeFile& file, const RetractionHabit& habit,
               const std::vector<TravelModel>& travel, const LinkDonors& donors,
               const HeadRoom& room, const IslandRests& rests);

  // The column of layer `layer`, with the file's own order.
  void Begin(size_t layer, LayerColumn& column) const;

  // Adds the file's own order as it is written if what is hidden does not retract, if that makes a
  // difference.
  void AddHidden(size_t layer, LayerColumn& column) const;

  // Adds `order`, of layer `layer`, with walls spared, unless the column has it. Where that leaves
  // fewer travel moves across them with an open nozzle than the file has, there may be time to win:
  // so it is written as the file would have it as well.
  void Add(const LayerOrder& order, size_t layer, LayerColumn& column) const;

 private:
  std::unique_ptr<const LayerWriter> WriterOf(size_t layer, const RetractionHabit& habit,
                                              bool hides) const;

  // Returns the text of its paths.
  std::string Add(const LayerOrder& order, size_t layer, const LayerWriter& writer,
                  LayerColumn& column) const;

  const GcodeFile& file_;
  const RetractionHabit& habit_;
  const RetractionHabit plain_habit_;
  const std::vector<TravelModel>& travel_;
  const LinkDonors& donors_;
  const HeadRoom& room_;
  const IslandRests& rests_;
};

// The file's own order, and the two of the others that take the least time.
std::vector<LayerOrder> FastestOrders(const LayerColumn& column);

// Writes and measures the travel from each choice of `before` to each of `column`, unless it is
// refused or known. The file's own orders one after the other may always be chosen.
void FillTravels(const GcodeFile& file, const LayerColumn& before, LayerColumn& column);

// Forbids those after which an island rests too short.
void ForbidShortRests(const IslandRests& rests, size_t layer, const LayerColumn& before,
                      LayerColumn& column);

// The layers of the file in its own order, or as chosen.
std::vector<TimedLayer> TimedRow(const std::vector<LayerColumn>& columns, bool as_chosen);

// True if an island of the chosen row rests too short.
bool AnyShortRest(const IslandRests& rests, const std::vector<LayerColumn>& columns);

// Where an island of the chosen row rests too short that lies on a layer before the last one, rules
// out what was chosen for its layer; else for the layers below. True if there is such an island.
bool RuleOutShortRests(const IslandRests& rests, std::vector<LayerColumn>& columns);

// The seconds of the travel within a layer in `order`, as it is estimated: as written, or with
// what is hidden as sliced.
double ForecastPaths(const LayerWriter& writer, const LayerOrder& order,
                     Hiding hiding = Hiding::kBent);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_LAYER_COLUMN_H_
