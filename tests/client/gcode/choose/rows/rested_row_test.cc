// Turned orders of all layers in which islands rest: client/gcode/choose/rows/rested_row.h.

#include "client/gcode/choose/rows/rested_row.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace traverse::gcode {
namespace {

constexpr size_t kIslands = 6;

// Islands 10 mm apart on a line, of two seconds each, the same in each layer. The file goes along
// the line in each layer, and back to its begin.
class RestedStack {
 public:
  RestedStack(size_t layers, double least_seconds) : rests_(IslandsOf(layers), least_seconds) {
    for (uint32_t path = 0; path < kIslands; ++path) islands_.push_back(path);
    for (size_t layer = 0; layer < layers; ++layer) layers_.push_back(LayerAt(layer));
    std::vector<TimedLayer> given;
    for (const TurnedLayer& layer : layers_) {
      given.push_back({&layer.given_times, layer.given_travel_mm / 100});
    }
    rests_.SetGiven(given);
  }

  std::vector<std::optional<uint32_t>> Row() const { return RestedRow(rests_, layers_, 0); }

  double TravelOf(const std::vector<std::optional<uint32_t>>& row) const {
    double mm = 0;
    Point at{};
    for (size_t layer = 0; layer < row.size(); ++layer) {
      const TurnedLayer& of = layers_[layer];
      if (layer > 0) mm += Distance(at, row[layer] ? of.begin[*row[layer]] : of.given_begin);
      mm += (row[layer] ? of.turns.TotalsOf(*row[layer]) : of.given).mm;
      at = row[layer] ? of.end[*row[layer]] : of.given_end;
    }
    return mm;
  }

  bool Rests(const std::vector<std::optional<uint32_t>>& row) const {
    std::vector<IslandTimes> times;
    for (size_t layer = 0; layer < row.size(); ++layer) {
      const TurnedLayer& of = layers_[layer];
      times.push_back(row[layer] ? rests_.TimesOf(layer, of.turns.OrderOf(*row[layer]),
                                                  of.first_block, of.turns.MomentsOf(*row[layer]))
                                 : of.given_times);
    }
    for (size_t layer = 1; layer < row.size(); ++layer) {
      const TurnedLayer& of = layers_[layer];
      const TurnedLayer& before = layers_[layer - 1];
      const Point from = row[layer - 1] ? before.end[*row[layer - 1]] : before.given_end;
      const Point to = row[layer] ? of.begin[*row[layer]] : of.given_begin;
      const double seconds = Distance(from, to) / 100;
      if (rests_.TooShort(layer, times[layer - 1], {&times[layer], seconds})) return false;
    }
    return true;
  }

 private:
  static std::vector<LayerIslands> IslandsOf(size_t layers) {
    std::vector<LayerIslands> stack(layers);
    for (uint32_t layer = 0; layer < layers; ++layer) {
      for (uint32_t path = 0; path < kIslands; ++path) {
        stack[layer].island.push_back(path);
        if (layer > 0) stack[layer].supports.push_back({layer - 1, path, path});
      }
      stack[layer].tree = IslandTree(kIslands);
    }
    return stack;
  }

  TurnedLayer LayerAt(size_t layer) {
    const auto first = static_cast<uint32_t>(layer * kIslands);
    const auto point = [first](const Placement& placement) {
      return Point{(placement.block - first) * 10.0, 0};
    };
    const TravelEstimate estimate = [point](size_t, const Placement& from, const Placement& to) {
      const double mm = Distance(point(from), point(to));
      return TravelTotals{.seconds = mm / 100, .mm = mm};
    };
    LayerOrder given;
    for (uint32_t path = 0; path < kIslands; ++path) given.push_back({first + path});
    LayerFreedom freedom;
    freedom.rules.resize(kIslands);
    freedom.group.assign(kIslands, first);
    freedom.goes_on.assign(kIslands, false);
    LayerClock clock;
    clock.path_seconds.assign(kIslands, 2);
    clock.travel_mm_s = 100;
    const OrderMerger judge(estimate, {});
    TurnedLayer turned;
    turned.first_block = first;
    turned.turns = IslandTurns(given, {given}, {islands_}, 3, freedom, estimate, judge, clock);
    turned.given = judge.TotalsOf(given);
    std::vector<double> moments;
    for (size_t path = 0; path < kIslands; ++path) {
      moments.push_back(2.1 * static_cast<double>(path));
      moments.push_back(moments.back() + 2);
    }
    turned.given_times = rests_.TimesOf(layer, given, first, moments);
    turned.given_begin = point(given.front());
    turned.given_end = point(given.back());
    turned.given_travel_mm = layer > 0 ? 50 : 0;
    for (size_t turn = 0; turn < turned.turns.size(); ++turn) {
      const LayerOrder order = turned.turns.OrderOf(turn);
      turned.begin.push_back(point(order.front()));
      turned.end.push_back(point(order.back()));
    }
    return turned;
  }

  IslandRests rests_;
  std::vector<uint32_t> islands_;
  std::vector<TurnedLayer> layers_;
};

TEST(RestedRow, GoesBackAndForthWhereNothingMustRest) {
  const RestedStack stack(4, 0);

  EXPECT_NEAR(stack.TravelOf(stack.Row()), 4 * 50, 1e-6);
}

TEST(RestedRow, IslandsRestAndMostOfTheTravelIsSaved) {
  const RestedStack stack(4, 3);

  const auto row = stack.Row();

  EXPECT_TRUE(stack.Rests(row));
  EXPECT_LT(stack.TravelOf(row), 4 * 50 + 3 * 50 - 1);  // the file's
  EXPECT_LE(stack.TravelOf(row), 4 * 50 + 3 * 40);
}

TEST(RestedRow, TheFilesOwnOrdersWhereNoOtherLetsThemRest) {
  // Each island rests as long as a layer takes: only one and the same sequence leaves it that.
  const RestedStack stack(3, 100);

  const auto row = stack.Row();

  EXPECT_TRUE(stack.Rests(row));
}

}  // namespace
}  // namespace traverse::gcode
