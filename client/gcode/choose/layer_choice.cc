#include "client/gcode/choose/layer_choice.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "client/gcode/choose/fast_forecast.h"
#include "client/gcode/choose/rows/choice_row.h"
#include "client/gcode/choose/rows/rested_row.h"
#include "client/gcode/hidden/hidden_moves.h"
#include "client/gcode/parallel.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/plan/stacked_islands.h"
#include "client/gcode/read/least_layer_time.h"

namespace traverse::gcode {
namespace {

// What a crossing of a visible wall counts in rows of turned orders. If the file has too many
// crossings, the second row has fewer.
constexpr double kCrossingSeconds[] = {0, 0.25};

// Travel moves that all layers together remember between the steps of choosing.
constexpr size_t kMostRemembered = 400'000;

// For so long islands must rest.
double LeastRestSeconds(const GcodeFile& file, const Liberties& liberties) {
  const double asked = liberties.min_revisit_seconds;
  return IsFree(liberties.policy) ? asked : std::max(asked, LeastLayerSeconds(file.text));
}

}  // namespace

LayerChooser::LayerChooser(const GcodeFile& file, const FileOrder& found,
                           const ChoiceOptions& options)
    : file_(file),
      found_(found),
      options_(options),
      habit_(HabitOfNewTravels(file, AllowedUnder(options.policy, options.allow), options.threads,
                               options.hidden)),
      donors_(file),
      room_(file),
      rests_(StackIslands(file, options.threads), LeastRestSeconds(file, options)),
      travel_(LearnTravel(file, options.threads)),
      filler_(file, habit_, travel_, donors_, room_, rests_),
      objects_(file),
      columns_(file.layers.size()) {
  ForEachLayer(All(), [this](size_t layer) { FillColumn(layer); });
  rests_.SetGiven(TimedRow(columns_, false));
  const auto fill = [this](size_t i) { gcode::FillTravels(file_, columns_[i], columns_[i + 1]); };
  ParallelFor(columns_.size() - 1, options_.threads, fill);
  bool added = false;
  for (size_t layer = 1; layer < columns_.size(); ++layer) added |= AddPastObstacles(layer);
  if (added) ParallelFor(columns_.size() - 1, options_.threads, fill);
  AddRested();
  ParallelFor(columns_.size() - 1, options_.threads, [this](size_t i) { FillTravels(i + 1); });
}

ChosenLayers LayerChooser::Choose() {
  Repair();
  ChooseRow();
  if (options_.polish && !std::exchange(polished_, true)) {
    KickChosen();
    ChooseRow();
    if (SpareRetractions()) ChooseRow();
    for (LayerColumn& column : columns_) column.known_travels.reset();
  }
  return Write();
}

bool LayerChooser::RuleOutLink(size_t layer, size_t line) {
  LayerColumn& column = columns_[layer];
  if (column.chosen == 0) return false;
  column.totals.no_choice[column.chosen] = true;
  column.refusals.RefuseLink(column.Chosen().order, PlaceOfLine(column, line));
  return true;
}

bool LayerChooser::RuleOutOrder(size_t layer, size_t line, size_t before) {
  LayerColumn& column = columns_[layer];
  if (column.chosen == 0) return false;
  const bool refused =
      column.refusals.RefuseOrder(column.Chosen().order, file_.layers[layer].first_block,
                                  PlaceOfLine(column, line), PlaceOfLine(column, before));
  if (refused) column.totals.no_choice[column.chosen] = true;
  return refused;
}

bool LayerChooser::RuleOutPath(size_t layer, size_t line) {
  LayerColumn& column = columns_[layer];
  const LayerOrder& order = column.Chosen().order;
  const size_t place = column.chosen == 0 ? order.size() : PlaceOfLine(column, line);
  return place < order.size() && column.refusals.RefusePlaceOf(order[place]);
}

bool LayerChooser::RuleOutTravel(size_t layer) {
  if (layer == 0) return false;
  LayerColumn& column = columns_[layer];
  LayerColumn& before = columns_[layer - 1];
  if (before.chosen == 0 && column.chosen == 0) return false;
  const LinkEnds link{before.Chosen().order.back(), column.Chosen().order.front()};
  const bool own = link == LinkEnds{before.given_order().back(), column.given_order().front()};
  column.refusals.RefuseTravel(before.chosen, column.chosen, own ? nullptr : &link);
  column.refusals.begin = column.chosen != 0;
  before.refusals.end = before.chosen != 0;
  return true;
}

bool LayerChooser::RuleOutStarts(size_t layer) {
  return columns_[layer].refusals.RefuseStarts(columns_[layer].Chosen().order);
}

bool LayerChooser::RuleOutAll(size_t layer) {
  LayerColumn& column = columns_[layer];
  for (size_t c = 1; c < column.choices.size(); ++c) column.totals.no_choice[c] = true;
  column.refusals.any = column.choices.size() > 1;
  column.refusals.Forget();
  return column.chosen != 0;
}

double LayerChooser::SecondsSavedByFast() const {
  return gcode::SecondsSavedByFast(file_, columns_, travel_, donors_, room_, options_.allow);
}

std::vector<size_t> LayerChooser::All() const {
  std::vector<size_t> all(columns_.size());
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

// Calls work(layer), which may ask for the layer's travel moves, side by side.
void LayerChooser::ForEachLayer(const std::vector<size_t>& layers,
                                const std::function<void(size_t)>& work) {
  ParallelFor(layers.size(), options_.threads, [&](size_t i) {
    work(layers[i]);
    const auto& travels = columns_[layers[i]].known_travels;
    if (travels != nullptr) travels->Shrink(kMostRemembered / columns_.size());
  });
}

void LayerChooser::ChooseRow() {
  do {
    TakeBestRow();
  } while (RuleOutShortRests(rests_, columns_));
}

void LayerChooser::TakeBestRow() {
  std::vector<const ChoiceColumn*> totals;
  for (const LayerColumn& column : columns_) totals.push_back(&column.totals);
  const std::vector<uint32_t> row = BestRow(totals, options_.crossings, fewer_crossings_);
  for (size_t layer = 0; layer < columns_.size(); ++layer) columns_[layer].Take(row[layer]);
}

// By which the orders of a layer are merged. What may change in it is known if small changes are
// to be made, and `with_freedom`.
MergeRules LayerChooser::RulesOf(size_t layer, bool with_freedom) const {
  MergeRules rules{.policy = options_.policy,
                   .crossings = options_.crossings,
                   .as_many_retractions = columns_[layer].totals.inside[0].PushesExtra(),
                   .polish = options_.polish,
                   .ordered = columns_[layer].refusals.ordered};
  if (with_freedom || options_.polish) {
    rules.freedom = FreedomOf(file_, file_.layers[layer], options_.policy, options_.allow);
    rules.freedom->ordered.insert(rules.freedom->ordered.end(), rules.ordered.begin(),
                                  rules.ordered.end());
  }
  if (options_.polish && habit_.avoids_walls) {
    rules.polish->seconds_per_travel = PolishLimit::kSecondsPerDetour;
  }
  return rules;
}

// The search found an order for layer `layer` besides the file's own.
bool LayerChooser::AnyFound(size_t layer) const {
  return !found_.empty() && !found_[layer].empty() &&
         found_[layer] != columns_[layer].given_order();
}

// What was chosen, improved as far as it is worth it: nothing else is, for that takes long.
void LayerChooser::KickChosen() {
  const auto is_new = [this](size_t layer) {
    return AnyFound(layer) || columns_[layer].chosen != 0;
  };
  AddWhere(is_new, [this](size_t layer) {
    LayerColumn& column = columns_[layer];
    const MergeRules rules = RulesOf(layer);
    LayerMerge merge(column.travels(), rules);
    filler_.Add(merge.Improve(column.Chosen().order, LayerMerge::Effort::kKick), layer, column);
  });
}

// Where the file would retract more often than before, gives the layers that do so other orders
// to choose from. True if there are such layers.
bool LayerChooser::SpareRetractions() {
  int64_t more = 0;
  for (size_t layer = 0; layer < columns_.size(); ++layer) {
    const ChoiceColumn& totals = columns_[layer].totals;
    const size_t before = layer > 0 ? columns_[layer - 1].chosen : 0;
    more +=
        totals.Whole(before, columns_[layer].chosen).retractions - totals.Whole(0, 0).retractions;
  }
  const auto retracts_more = [this](size_t layer) {
    const std::vector<PrintTotals>& inside = columns_[layer].totals.inside;
    return inside[columns_[layer].chosen].retractions > inside[0].retractions;
  };
  return more > 0 && AddWhere(retracts_more, [this](size_t layer) { AddSparing(layer); });
}

// Calls add(layer), which adds choices, for the layers of which `where` is true. True if there are
// such layers.
bool LayerChooser::AddWhere(const std::function<bool(size_t)>& where,
                            const std::function<void(size_t)>& add) {
  std::vector<size_t> layers;
  for (size_t layer = 0; layer < columns_.size(); ++layer) {
    if (where(layer)) layers.push_back(layer);
  }
  ForEachLayer(layers, add);
  std::vector<size_t> travels;
  for (const size_t layer : layers) {
    if (layer > 0 && (travels.empty() || travels.back() != layer)) travels.push_back(layer);
    if (layer + 1 < columns_.size()) travels.push_back(layer + 1);
  }
  ParallelFor(travels.size(), options_.threads, [&](size_t i) { FillTravels(travels[i]); });
  return !layers.empty();
}

// Where links of what was chosen are ruled out, adds the same without them.
void LayerChooser::Repair() {
  AddWhere([this](size_t layer) { return columns_[layer].refusals.ask(); },
           [this](size_t layer) { AddRepaired(layer); });
}

void LayerChooser::AddRepaired(size_t layer) {
  LayerColumn& column = columns_[layer];
  Refusals& refusals = column.refusals;
  std::optional<LayerOrder> order = column.Chosen().order;
  for (Placement& placement : *order) {
    if (refusals.Refuse(placement)) placement.entry = 0;
  }
  if (refusals.inside) {
    MergeRules rules = RulesOf(layer, /*with_freedom=*/true);
    rules.refused = &refusals.links;
    order = LayerMerge(column.travels(), rules).Repair(*order, refusals.Reach());
  }
  if (order && refusals.begin) order = BegunAsSliced(*order, column.given_order());
  if (order && refusals.end) order = EndedAsSliced(*order, column.given_order());
  refusals.Forget();
  if (order) filler_.Add(*order, layer, column);
  for (size_t c = 1; c < column.choices.size(); ++c) {
    const bool refused = refusals.Refuse(column.choices[c].order, file_.layers[layer].first_block);
    if (refused) column.totals.no_choice[c] = true;
  }
}

void LayerChooser::AddSparing(size_t layer) {
  LayerColumn& column = columns_[layer];
  const MergeRules rules = RulesOf(layer);
  if (rules.as_many_retractions) return;
  const auto orders = LayerMerge(column.travels(), rules).Spare(column.Chosen().order);
  for (const LayerOrder& order : orders) filler_.Add(order, layer, column);
}

void LayerChooser::FillColumn(size_t layer) {
  LayerColumn& column = columns_[layer];
  filler_.Begin(layer, column);
  filler_.AddHidden(layer, column);
  MergeRules rules = RulesOf(layer, /*with_freedom=*/objects_.any());
  AddMerged(layer, rules, column);
  if (options_.crossings == Crossings::kFewer) {
    // What is made at that price is often too long.
    rules.crossings = Crossings::kKeep;
    AddMerged(layer, rules, column);
  }
  if (!objects_.any() || found_.empty() || found_[layer].empty()) return;
  objects_.AddTo(layer, rules, filler_, column);
}

// The order found for layer `layer`, merged by `rules`.
void LayerChooser::AddMerged(size_t layer, const MergeRules& rules, LayerColumn& column) {
  if (!AnyFound(layer)) return;
  const LayerOrder& found = found_[layer];
  if (const LayerWriter& writer = *column.writer; writer.room() != nullptr) {
    LinkParts parts(file_);
    for (size_t place = 1; place < found.size(); ++place) {
      const auto link = writer.EstimateTravel(place, found[place - 1], found[place], parts);
      column.blocked |= link.blocked > 0;
    }
  }
  const auto orders = LayerMerge(column.travels(), rules).Merge(found);
  for (const LayerOrder& order : orders) filler_.Add(order, layer, column);
}

// Where something stands in the way to the begin of a choice, or from the end of one to this
// layer, and does not in the file, adds the same choice with the file's begin or end. Whether it
// did.
bool LayerChooser::AddPastObstacles(size_t layer) {
  LayerColumn& column = columns_[layer];
  LayerColumn& before = columns_[layer - 1];
  if (column.writer->room() == nullptr) return false;
  std::vector<LayerOrder> begun;
  for (size_t c = 1; c < column.choices.size(); ++c) {
    if (column.totals.Travel(0, c).blocked == 0) continue;
    begun.push_back(BegunAsSliced(column.choices[c].order, column.given_order()));
  }
  std::vector<LayerOrder> ended;
  for (size_t b = 1; b * column.choices.size() < column.totals.travels.size(); ++b) {
    if (column.totals.Travel(b, 0).blocked == 0) continue;
    ended.push_back(EndedAsSliced(before.choices[b].order, before.given_order()));
  }
  for (const LayerOrder& order : begun) filler_.Add(order, layer, column);
  for (const LayerOrder& order : ended) filler_.Add(order, layer - 1, before);
  const bool added = !begun.empty() || !ended.empty();
  column.blocked |= added;
  return added;
}

void LayerChooser::FillTravels(size_t layer) {
  gcode::FillTravels(file_, columns_[layer - 1], columns_[layer]);
  ForbidShortRests(rests_, layer, columns_[layer - 1], columns_[layer]);
}

// If islands rest too short in the row that would be the best one, adds turned orders in which
// they rest long enough.
void LayerChooser::AddRested() {
  if (rests_.least_seconds() <= 0 || columns_.size() < 2) return;
  TakeBestRow();
  if (!AnyShortRest(rests_, columns_)) return;
  std::vector<TurnedLayer> turned(columns_.size());
  ForEachLayer(All(), [&](size_t layer) { turned[layer] = TurnsOf(layer); });
  std::vector<std::optional<uint32_t>> added(columns_.size());
  for (const double crossing_seconds : kCrossingSeconds) {
    const auto row = RestedRow(rests_, turned, crossing_seconds);
    ForEachLayer(All(), [&](size_t layer) {
      if (!row[layer] || row[layer] == added[layer]) return;
      AddTurned(layer, turned[layer].turns, *row[layer]);
      added[layer] = row[layer];
    });
  }
}

TurnedLayer LayerChooser::TurnsOf(size_t layer) {
  LayerColumn& column = columns_[layer];
  const MergeRules rules = RulesOf(layer, /*with_freedom=*/true);
  TurnedLayer turned = LayerMerge(column.travels(), rules)
                           .Turn(FastestOrders(column), travel_[layer], rests_.IslandsOf(layer),
                                 rests_.least_seconds(), column.given_moments);
  turned.given_times = column.choices[0].times;
  if (layer > 0) turned.given_travel_mm = column.totals.Travel(0, 0).travel_mm;
  return turned;
}

void LayerChooser::AddTurned(size_t layer, const IslandTurns& turns, size_t turn) {
  LayerOrder order = turns.OrderOf(turn);
  if (options_.polish) {
    const MergeRules rules = RulesOf(layer);
    const LayerMerge merge(columns_[layer].travels(), rules);
    order = merge.SettleWithin(order, turns.UnitsOf(turn));
  }
  filler_.Add(order, layer, columns_[layer]);
}

ChosenLayers LayerChooser::Write() const {
  ChosenLayers chosen = WriteChosen(file_, columns_, options_.threads);
  chosen.rest = {rests_.least_seconds(), rests_.LeastOf(TimedRow(columns_, false)),
                 rests_.LeastOf(TimedRow(columns_, true))};
  return chosen;
}

}  // namespace traverse::gcode
