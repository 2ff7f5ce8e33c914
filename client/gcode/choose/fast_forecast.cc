#include "client/gcode/choose/fast_forecast.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "client/gcode/choose/merged_orders.h"
#include "client/gcode/choose/orders/known_travels.h"
#include "client/gcode/choose/rows/cheapest_row.h"
#include "client/gcode/hidden/hidden_moves.h"

namespace traverse::gcode {
namespace {

// Layers for each that is looked at: what that takes is little beside all that a file takes.
constexpr size_t kOneIn = 16;
constexpr size_t kLeast = 3;

// The layers before the first and behind the last one hide nothing.
std::vector<size_t> TypicalLayers(const std::vector<LayerColumn>& columns) {
  const size_t inner = columns.size() - 2;
  const size_t runs = std::min(inner, std::max(columns.size() / kOneIn, kLeast));
  std::vector<size_t> typical;
  for (size_t run = 0; run < runs; ++run) {
    std::vector<std::pair<int64_t, size_t>> layers;  // retractions, layer
    for (size_t i = run * inner / runs; i < (run + 1) * inner / runs; ++i) {
      layers.emplace_back(columns[i + 1].totals.inside[0].retractions, i + 1);
    }
    const auto middle = layers.begin() + static_cast<std::ptrdiff_t>(layers.size() / 2);
    std::nth_element(layers.begin(), middle, layers.end());
    typical.push_back(middle->second);
  }
  return typical;
}

// The seconds of the travel within a layer of `column` in the best order found by `rules`, or in
// the file's own, as `writer` has them.
double FastSeconds(const LayerWriter& writer, const LayerColumn& column, const MergeRules& rules) {
  // Where whole objects have changed places, the file's own order begins it.
  const LayerOrder& chosen = column.Chosen().order;
  const std::vector<uint32_t> places = writer.PlacesOf(chosen);
  const bool moved = !std::is_sorted(places.begin(), places.end());
  KnownTravels travels(writer);
  const LayerOrder searched =
      LayerMerge(travels, rules)
          .Improve(moved ? column.given_order() : chosen, LayerMerge::Effort::kKick);
  return std::min(ForecastPaths(writer, column.given_order()), ForecastPaths(writer, searched));
}

// What the travel between layers takes in the row of the least time, whatever the islands rest:
// that policy does not ask for it.
double LeastBetweenLayers(const std::vector<LayerColumn>& columns) {
  CheapestRow cheapest;
  for (const LayerColumn& column : columns) {
    const ChoiceColumn& totals = column.totals;
    const bool first = &column == &columns.front();
    cheapest.Extend(
        column.choices.size(),
        [&](uint32_t before, uint32_t choice, double up_to) {
          const double travel = first ? 0 : totals.Travel(before, choice).seconds;
          return up_to + travel + totals.inside[choice].seconds;
        },
        [&](uint32_t before, uint32_t choice) {
          return first || column.measured[before * column.choices.size() + choice];
        });
  }
  const std::vector<uint32_t> row = cheapest.Choices();
  double between = 0;
  for (size_t layer = 1; layer < columns.size(); ++layer) {
    between += columns[layer].totals.Travel(row[layer - 1], row[layer]).seconds;
  }
  return between;
}

// What is saved where little is hidden: as chosen in the first and the last layer, and between
// layers.
double SavedElsewhere(const std::vector<LayerColumn>& columns) {
  double saved = 0;
  for (const size_t layer : {size_t{0}, columns.size() - 1}) {
    const LayerColumn& column = columns[layer];
    const LayerChoice& chosen = column.Chosen();
    if (column.chosen == 0) continue;
    saved += ForecastPaths(*column.writer, column.given_order()) -
             ForecastPaths(*chosen.writer, chosen.order);
  }
  for (size_t layer = 1; layer < columns.size(); ++layer) {
    saved += columns[layer].totals.Travel(0, 0).seconds;
  }
  return saved - LeastBetweenLayers(columns);
}

}  // namespace

double SecondsSavedByFast(const GcodeFile& file, const std::vector<LayerColumn>& columns,
                          const std::vector<TravelModel>& travel, const LinkDonors& donors,
                          const HeadRoom& room, Allowance allow) {
  if (columns.size() < 3) return 0;
  allow = AllowedUnder(Policy::kFast, allow);
  const std::vector<size_t> layers = TypicalLayers(columns);
  const RetractionHabit habit = HabitOfNewTravels(
      file, allow, 1,
      std::make_shared<const HiddenMoves>(file, allow.max_hidden_travel_mm, layers));
  double given = 0;
  double saved = 0;
  for (const size_t i : layers) {
    const Layer& layer = file.layers[i];
    const bool hides = !columns[i].totals.inside[0].PushesExtra();
    const LayerWriter writer(file, layer, habit, donors, room.Of(i), hides, &travel[i]);
    // As soon as fast itself gives up where it leads around walls: the rest changes little.
    const MergeRules rules{
        .policy = Policy::kFast,
        .as_many_retractions = !hides,
        .freedom = FreedomOf(file, layer, Policy::kFast, allow),
        .polish = PolishLimit{.seconds_per_travel = PolishLimit::kSecondsPerDetour}};
    const double own = ForecastPaths(*columns[i].writer, columns[i].given_order());
    given += own;
    saved += own - std::min(own, FastSeconds(writer, columns[i], rules));
  }
  if (given <= 0) return 0;
  double all = 0;
  for (size_t layer = 1; layer + 1 < columns.size(); ++layer) {
    all += ForecastPaths(*columns[layer].writer, columns[layer].given_order());
  }
  return saved / given * all + SavedElsewhere(columns);
}

}  // namespace traverse::gcode
