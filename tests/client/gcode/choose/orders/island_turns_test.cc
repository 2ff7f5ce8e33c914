// Orders of a layer that begin at other islands: client/gcode/choose/orders/island_turns.h.

#include "client/gcode/choose/orders/island_turns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace traverse::gcode {
namespace {

// Paths of one second each at `at` mm along a line.
struct TurnedRow {
  std::vector<double> at;
  std::vector<uint32_t> islands;
  LayerFreedom freedom;

  TurnedRow(std::vector<double> places, std::vector<uint32_t> of)
      : at(std::move(places)), islands(std::move(of)) {
    freedom.rules.resize(at.size());
    freedom.group.assign(at.size(), 0);
    freedom.goes_on.assign(at.size(), false);
    freedom.island = islands;
  }

  LayerOrder Order(const std::vector<uint32_t>& paths) const {
    LayerOrder order;
    for (const uint32_t path : paths) order.push_back({path});
    return order;
  }

  LayerOrder Given() const {
    LayerOrder order;
    for (uint32_t path = 0; path < at.size(); ++path) order.push_back({path});
    return order;
  }

  TravelTotals TotalsOf(const LayerOrder& order) const {
    TravelTotals totals;
    for (size_t i = 1; i < order.size(); ++i) {
      const double mm = std::abs(at[order[i].block] - at[order[i - 1].block]);
      totals.mm += mm;
      totals.seconds += mm;
    }
    return totals;
  }

  IslandTurns Turns(const std::vector<LayerOrder>& found) const {
    const TravelEstimate estimate = [this](size_t, const Placement& from, const Placement& to) {
      return TotalsOf({from, to});
    };
    LayerClock clock;
    clock.path_seconds.assign(at.size(), 1);
    clock.travel_mm_s = 1;
    return {Given(), found, {islands}, 4, freedom, estimate, OrderMerger(estimate, {}), clock};
  }
};

std::set<std::vector<uint32_t>> PathsOf(const IslandTurns& turns) {
  std::set<std::vector<uint32_t>> all;
  for (size_t turn = 0; turn < turns.size(); ++turn) {
    std::vector<uint32_t> paths;
    for (const Placement& placement : turns.OrderOf(turn)) paths.push_back(placement.block);
    all.insert(paths);
  }
  return all;
}

TEST(IslandTurns, BeginsAtEachIslandAndGoesBothWaysRound) {
  const TurnedRow row({0, 1, 10, 11, 20}, {0, 0, 1, 1, 2});

  const std::set<std::vector<uint32_t>> orders = PathsOf(row.Turns({row.Given()}));

  EXPECT_EQ(orders, (std::set<std::vector<uint32_t>>{{0, 1, 2, 3, 4},
                                                     {2, 3, 4, 0, 1},
                                                     {4, 0, 1, 2, 3},
                                                     {4, 2, 3, 0, 1},
                                                     {2, 3, 0, 1, 4},
                                                     {0, 1, 4, 2, 3}}));
}

TEST(IslandTurns, TotalsAndMomentsAreThoseOfTheOrder) {
  const TurnedRow row({0, 1, 10, 11, 20, 31}, {0, 0, 1, 1, 2, 3});

  const IslandTurns turns = row.Turns({row.Given(), row.Order({4, 0, 2, 1, 3, 5})});

  ASSERT_GT(turns.size(), 8u);
  for (size_t turn = 0; turn < turns.size(); ++turn) {
    const LayerOrder order = turns.OrderOf(turn);
    EXPECT_NEAR(turns.TotalsOf(turn).mm, row.TotalsOf(order).mm, 1e-6);
    const std::vector<double> moments = turns.MomentsOf(turn);
    ASSERT_EQ(moments.size(), 2 * order.size());
    for (size_t i = 0; i < order.size(); ++i) {
      const LayerOrder up_to(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      EXPECT_NEAR(moments[2 * i], row.TotalsOf(up_to).mm + static_cast<double>(i), 1e-4);
      EXPECT_NEAR(moments[2 * i + 1] - moments[2 * i], 1, 1e-9);
    }
  }
}

TEST(IslandTurns, KeepsTogetherWhatMustFollowAndWhatHasAnOrder) {
  TurnedRow row({0, 10, 20, 30}, {0, 1, 2, 3});
  row.freedom.goes_on[1] = true;
  row.freedom.ordered.emplace_back(2, 3);

  for (const std::vector<uint32_t>& paths : PathsOf(row.Turns({row.Given()}))) {
    std::vector<size_t> place(paths.size());
    for (size_t i = 0; i < paths.size(); ++i) place[paths[i]] = i;
    EXPECT_EQ(place[1], place[0] + 1);
    EXPECT_LT(place[2], place[3]);
  }
}

TEST(IslandTurns, StaysWithinGroups) {
  TurnedRow row({0, 10, 20, 30, 40}, {0, 1, 2, 3, 4});
  row.freedom.group = {0, 0, 2, 2, 2};

  const std::set<std::vector<uint32_t>> orders = PathsOf(row.Turns({row.Given()}));

  EXPECT_EQ(orders.count({1, 0, 2, 3, 4}), 1u);
  EXPECT_EQ(orders.count({0, 1, 3, 4, 2}), 1u);
  for (const std::vector<uint32_t>& paths : orders) {
    EXPECT_LT(paths[0], 2u);
    EXPECT_LT(paths[1], 2u);
  }
}

TEST(IslandTurns, OfManyIslandsOnlyTheBestInEachStretch) {
  std::vector<double> at;
  std::vector<uint32_t> islands;
  for (uint32_t i = 0; i < 500; ++i) {
    at.push_back(i % 7 + i * 10);
    islands.push_back(i);
  }
  const TurnedRow row(at, islands);

  const IslandTurns turns = row.Turns({row.Given()});

  EXPECT_LE(turns.size(), 2 * IslandTurns::kMostOfAKind);
  std::set<uint32_t> tenths;
  for (size_t turn = 0; turn < turns.size(); ++turn)
    tenths.insert(turns.OrderOf(turn).front().block / 50);
  EXPECT_EQ(tenths.size(), 10u);
}

}  // namespace
}  // namespace traverse::gcode
