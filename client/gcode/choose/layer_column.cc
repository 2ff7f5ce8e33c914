#include "client/gcode/choose/layer_column.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "client/gcode/measure/layer_meter.h"

namespace traverse::gcode {
namespace {

// As slicers write it: a sign that the extruder's register does not count through.
bool Resets(std::string_view text) { return text.find("G92") != std::string_view::npos; }

RetractionHabit SparingNoWalls(RetractionHabit habit) {
  habit.spares_walls = false;
  return habit;
}

// Choice `to` of `column` behind choice `from` of the layer before: the travel between them.
PrintTotals MeasureTravel(const GcodeFile& file, const LayerColumn& before, uint32_t from,
                          const LayerColumn& column, uint32_t to) {
  const LayerChoice& choice = before.choices[from];
  std::string text;
  column.writer->WriteTravel(choice.order.back(), column.choices[to].order.front(), choice.behind,
                             text);
  // Nothing is in the way of what the file itself does.
  const Room* room = from > 0 || to > 0 ? column.writer->room() : nullptr;
  return Measure(file, text, choice.behind, &column.writer->walls(), room);
}

bool IsRefused(const LayerColumn& before, uint32_t from, const LayerColumn& column, uint32_t to) {
  const LinkEnds link{before.choices[from].order.back(), column.choices[to].order.front()};
  return column.refusals.RefusesTravel(from, to, link);
}

}  // namespace

double ForecastPaths(const LayerWriter& writer, const LayerOrder& order, Hiding hiding) {
  double seconds = 0;
  LinkParts parts(writer.file());
  const std::vector<uint32_t> places = writer.PlacesOf(order);
  for (size_t place = 1; place < order.size(); ++place) {
    const Placement& from = order[place - 1];
    seconds += writer.EstimateTravel(places[place], from, order[place], parts, hiding).seconds;
  }
  return seconds;
}

size_t PlaceOfLine(LayerColumn& column, size_t line) {
  std::vector<size_t>& ends = column.ends;
  if (ends.empty()) {
    const LayerChoice& choice = column.Chosen();
    std::string text;
    choice.writer->WritePaths(choice.order, choice.start, text, &ends);
    size_t begin = 0;
    size_t lines = 0;
    for (size_t& end : ends) {
      const std::string_view path = std::string_view(text).substr(begin, end - begin);
      lines += static_cast<size_t>(std::count(path.begin(), path.end(), '\n'));
      begin = std::exchange(end, lines);
    }
  }
  return static_cast<size_t>(std::upper_bound(ends.begin(), ends.end(), line) - ends.begin());
}

ColumnFiller::ColumnFiller(const GcodeFile& file, const RetractionHabit& habit,
                           const std::vector<TravelModel>& travel, const LinkDonors& donors,
                           const HeadRoom& room, const IslandRests& rests)
    : file_(file),
      habit_(habit),
      plain_habit_(SparingNoWalls(habit)),
      travel_(travel),
      donors_(donors),
      room_(room),
      rests_(rests) {}

std::unique_ptr<const LayerWriter> ColumnFiller::WriterOf(size_t layer,
                                                          const RetractionHabit& habit,
                                                          bool hides) const {
  return std::make_unique<const LayerWriter>(file_, file_.layers[layer], habit, donors_,
                                             room_.Of(layer), hides, &travel_[layer]);
}

void ColumnFiller::Begin(size_t layer, LayerColumn& column) const {
  const Layer& of_file = file_.layers[layer];
  column.writer = WriterOf(layer, habit_, /*hides=*/true);
  LayerChoice& choice = column.choices.emplace_back();
  choice.order = column.writer->GivenOrder();
  choice.writer = column.writer.get();
  choice.start = StartOfPaths(file_, choice.order.front());
  choice.behind = StartBehind(file_, file_.blocks[of_file.end_block - 1]);
  choice.as_sliced = true;
  choice.resets_e = Resets(file_.PathsText(of_file));
  TextMoments moments;
  moments.offsets = PathMarks(file_, of_file);
  const VisibleWalls& walls = column.writer->walls();
  column.totals.inside.push_back(MeasurePaths(file_, of_file, walls, &moments));
  column.totals.no_choice.push_back(false);
  choice.times = rests_.TimesOf(layer, choice.order, of_file.first_block, moments.seconds);
  column.given_moments = std::move(moments.seconds);
  column.given_travel_seconds = MeasureTravel(file_, of_file, walls).nominal_seconds;
  if (!column.writer->hides() || !column.totals.inside[0].PushesExtra()) return;
  // Each retraction is part of what is printed.
  column.writer = WriterOf(layer, habit_, /*hides=*/false);
  choice.writer = column.writer.get();
}

void ColumnFiller::AddHidden(size_t layer, LayerColumn& column) const {
  if (!column.writer->ChangesGiven()) return;
  const LayerOrder given = column.given_order();
  Add(given, layer, *column.writer, column);
}

void ColumnFiller::Add(const LayerOrder& order, size_t layer, LayerColumn& column) const {
  if (std::ranges::find(column.choices, order, &LayerChoice::order) != column.choices.end()) return;
  const std::string sparing = Add(order, layer, *column.writer, column);
  if (!habit_.spares_walls || habit_.avoids_walls) return;
  const std::vector<PrintTotals>& inside = column.totals.inside;
  if (inside.back().open_crossings >= inside.front().open_crossings) return;
  if (column.plain == nullptr) {
    column.plain = WriterOf(layer, plain_habit_, column.writer->hides());
  }
  // A choice that is equal would have travel moves to and from all those of the layers beside it.
  if (Add(order, layer, *column.plain, column) != sparing) return;
  column.choices.pop_back();
  column.totals.inside.pop_back();
  column.totals.no_choice.pop_back();
}

std::string ColumnFiller::Add(const LayerOrder& order, size_t layer, const LayerWriter& writer,
                              LayerColumn& column) const {
  LayerChoice& choice = column.choices.emplace_back();
  choice.order = order;
  choice.writer = &writer;
  choice.start = StartOfPaths(file_, order.front());
  std::string text;
  TextMoments moments;
  choice.behind = writer.WriteBarePaths(order, choice.start, text, &moments.offsets);
  choice.resets_e = Resets(text);
  column.totals.inside.push_back(
      Measure(file_, text, choice.start, &column.writer->walls(), writer.room(), &moments));
  column.totals.no_choice.push_back(false);
  choice.times = rests_.TimesOf(layer, order, file_.layers[layer].first_block, moments.seconds);
  return text;
}

std::vector<LayerOrder> FastestOrders(const LayerColumn& column) {
  constexpr size_t kOthers = 2;
  std::vector<size_t> numbers;
  for (size_t c = 1; c < column.choices.size(); ++c) numbers.push_back(c);
  std::ranges::stable_sort(numbers, {},
                           [&column](size_t c) { return column.totals.inside[c].seconds; });
  numbers.resize(std::min(numbers.size(), kOthers));
  std::vector<LayerOrder> orders = {column.given_order()};
  for (const size_t c : numbers) orders.push_back(column.choices[c].order);
  return orders;
}

void FillTravels(const GcodeFile& file, const LayerColumn& before, LayerColumn& column) {
  const size_t n = column.choices.size();
  const size_t known_n = column.travels_to;
  const std::vector<PrintTotals> known = std::move(column.totals.travels);
  const std::vector<bool> was_measured = std::move(column.measured);
  column.totals.travels.assign(before.choices.size() * n, {});
  column.totals.no_travel.assign(before.choices.size() * n, false);
  column.measured.assign(before.choices.size() * n, false);
  column.travels_to = n;
  for (uint32_t b = 0; b < before.choices.size(); ++b) {
    for (uint32_t c = 0; c < n; ++c) {
      const size_t at = b * n + c;
      if ((b > 0 || c > 0) && IsRefused(before, b, column, c)) {
        column.totals.no_travel[at] = true;
        continue;
      }
      const size_t was = b * known_n + c;
      const bool is_known = c < known_n && was < was_measured.size() && was_measured[was];
      column.totals.travels[at] = is_known ? known[was] : MeasureTravel(file, before, b, column, c);
      column.measured[at] = true;
    }
  }
}

void ForbidShortRests(const IslandRests& rests, size_t layer, const LayerColumn& before,
                      LayerColumn& column) {
  const size_t n = column.choices.size();
  for (uint32_t b = 0; b < before.choices.size(); ++b) {
    for (uint32_t c = 0; c < n; ++c) {
      const size_t at = b * n + c;
      if ((b == 0 && c == 0) || column.totals.no_travel[at]) continue;
      column.totals.no_travel[at] =
          rests.TooShort(layer, before.choices[b].times,
                         {&column.choices[c].times, column.totals.travels[at].nominal_seconds});
    }
  }
}

std::vector<TimedLayer> TimedRow(const std::vector<LayerColumn>& columns, bool as_chosen) {
  std::vector<TimedLayer> row;
  for (size_t layer = 0; layer < columns.size(); ++layer) {
    const LayerColumn& column = columns[layer];
    const size_t chosen = as_chosen ? column.chosen : 0;
    TimedLayer& timed = row.emplace_back(TimedLayer{&column.choices[chosen].times, 0});
    if (layer == 0) continue;
    timed.travel_seconds =
        as_chosen ? column.totals.Travel(columns[layer - 1].chosen, chosen).nominal_seconds
                  : column.given_travel_seconds;
  }
  return row;
}

bool AnyShortRest(const IslandRests& rests, const std::vector<LayerColumn>& columns) {
  const std::vector<TimedLayer> print = TimedRow(columns, true);
  for (size_t layer = 1; layer < print.size(); ++layer) {
    if (rests.TooShort(layer, *print[layer - 1].islands, print[layer])) return true;
  }
  return !rests.TooShortBeyond(print).empty();
}

bool RuleOutShortRests(const IslandRests& rests, std::vector<LayerColumn>& columns) {
  bool any = false;
  for (const IslandRests::Pair& pair : rests.TooShortBeyond(TimedRow(columns, true))) {
    for (size_t layer = pair.layer + 1; layer-- > pair.below;) {
      LayerColumn& column = columns[layer];
      if (column.chosen == 0 || column.totals.no_choice[column.chosen]) continue;
      column.totals.no_choice[column.chosen] = true;
      any = true;
      break;
    }
  }
  return any;
}

}  // namespace traverse::gcode
