#include "client/gcode/choose/rows/island_rests.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/model/visible_walls.h"
#include "client/gcode/parallel.h"

namespace traverse::gcode {
namespace {

// A rest may be this much shorter: less than what counts.
constexpr double kShare = 0.955;

// Differences smaller than this do not count.
constexpr double kSameSeconds = 1e-6;

// When each layer of a print begins, in seconds.
std::vector<double> BeginsOf(const std::vector<TimedLayer>& print) {
  std::vector<double> begins;
  double at = 0;
  for (const TimedLayer& layer : print) {
    at += layer.travel_seconds;
    begins.push_back(at);
    at += layer.islands->seconds;
  }
  return begins;
}

double RestOf(const LayerIslands::Support& support, size_t layer,
              const std::vector<TimedLayer>& print, const std::vector<double>& begins) {
  return begins[layer] + print[layer].islands->begun[support.island] - begins[support.layer] -
         print[support.layer].islands->left[support.below];
}

}  // namespace

IslandRests::IslandRests(std::vector<LayerIslands> stack, double least_seconds)
    : stack_(std::move(stack)), least_seconds_(least_seconds) {}

std::vector<std::vector<uint32_t>> IslandRests::IslandsOf(size_t layer) const {
  const LayerIslands& islands = stack_[layer];
  std::vector<uint32_t> regions;
  for (const uint32_t island : islands.island) regions.push_back(islands.tree.RootOf(island));
  if (regions == islands.island) return {regions};
  return {regions, islands.island};
}

IslandTimes IslandRests::TimesOf(size_t layer, const LayerOrder& order, uint32_t first_block,
                                 const std::vector<double>& moments) const {
  assert(moments.size() == 2 * order.size());
  const LayerIslands& islands = stack_[layer];
  IslandTimes times;
  times.begun.assign(islands.tree.size(), std::numeric_limits<double>::infinity());
  times.left.assign(islands.tree.size(), 0);
  for (size_t i = 0; i < order.size(); ++i) {
    const uint32_t island = islands.island[order[i].block - first_block];
    times.begun[island] = std::min(times.begun[island], moments[2 * i]);
    times.left[island] = moments[2 * i + 1];
  }
  for (uint32_t node = 0; node < islands.tree.size(); ++node) {
    const uint32_t parent = islands.tree.ParentOf(node);
    times.begun[parent] = std::min(times.begun[parent], times.begun[node]);
    times.left[parent] = std::max(times.left[parent], times.left[node]);
  }
  times.seconds = moments.back();
  return times;
}

void IslandRests::SetGiven(const std::vector<TimedLayer>& given) {
  const std::vector<double> begins = BeginsOf(given);
  given_.resize(stack_.size());
  for (size_t layer = 0; layer < stack_.size(); ++layer) {
    given_[layer].clear();
    for (const Support& support : stack_[layer].supports) {
      const IslandTimes& below = *given[support.layer].islands;
      // Nothing else is printed in between.
      const bool at_once = support.layer + 1 == layer &&
                           below.left[support.below] > below.seconds - kSameSeconds &&
                           given[layer].islands->begun[support.island] < kSameSeconds;
      given_[layer].push_back(at_once ? 0 : RestOf(support, layer, given, begins));
    }
  }
}

double IslandRests::NeedOf(size_t layer, size_t support) const {
  return kShare * std::min(given_[layer][support], least_seconds_) - kSameSeconds;
}

bool IslandRests::TooShort(size_t layer, const IslandTimes& before, const TimedLayer& next) const {
  const std::vector<Support>& supports = stack_[layer].supports;
  for (size_t i = 0; i < supports.size(); ++i) {
    if (supports[i].layer + 1 != layer) continue;
    const double rest = before.seconds - before.left[supports[i].below] + next.travel_seconds +
                        next.islands->begun[supports[i].island];
    if (rest < NeedOf(layer, i)) return true;
  }
  return false;
}

std::vector<IslandRests::Pair> IslandRests::TooShortBeyond(
    const std::vector<TimedLayer>& print) const {
  const std::vector<double> begins = BeginsOf(print);
  std::vector<Pair> pairs;
  for (size_t layer = 0; layer < stack_.size(); ++layer) {
    const std::vector<Support>& supports = stack_[layer].supports;
    for (size_t i = 0; i < supports.size(); ++i) {
      if (supports[i].layer + 1 == layer) continue;
      const double rest = RestOf(supports[i], layer, print, begins);
      if (rest < NeedOf(layer, i)) pairs.push_back({supports[i].layer, layer});
    }
  }
  return pairs;
}

std::optional<LeastRest> IslandRests::LeastOf(const std::vector<TimedLayer>& print) const {
  const std::vector<double> begins = BeginsOf(print);
  std::optional<LeastRest> least;
  for (size_t layer = 0; layer < stack_.size(); ++layer) {
    for (size_t i = 0; i < stack_[layer].supports.size(); ++i) {
      const bool is_island = stack_[layer].supports[i].island < stack_[layer].tree.count();
      if (!is_island || given_[layer][i] <= 0) continue;
      const double rest = RestOf(stack_[layer].supports[i], layer, print, begins);
      if (!least || rest < least->seconds) least = {rest, layer};
    }
  }
  return least;
}

std::optional<LeastRest> LeastRestOf(const GcodeFile& file, int threads) {
  IslandRests rests(StackIslands(file, threads), 0);
  std::vector<IslandTimes> times(file.layers.size());
  std::vector<TimedLayer> given(file.layers.size());
  ParallelFor(given.size(), threads, [&](size_t i) {
    const Layer& layer = file.layers[i];
    LayerOrder order;
    for (uint32_t b = layer.first_block; b < layer.end_block; ++b) order.push_back({b});
    const VisibleWalls no_walls{std::vector<Outline>()};
    TextMoments moments;
    moments.offsets = PathMarks(file, layer);
    MeasurePaths(file, layer, no_walls, &moments);
    times[i] = rests.TimesOf(i, order, layer.first_block, moments.seconds);
    given[i] = {&times[i], MeasureTravel(file, layer, no_walls).nominal_seconds};
  });
  rests.SetGiven(given);
  return rests.LeastOf(given);
}

}  // namespace traverse::gcode
