// The best of several orders: client/gcode/choose/orders/order_merge.h.

#include "client/gcode/choose/orders/order_merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/base/rng.h"

namespace traverse::gcode {
namespace {

LayerOrder OrderOf(const std::vector<uint32_t>& blocks) {
  LayerOrder order;
  for (const uint32_t block : blocks) order.push_back({block, 0, false});
  return order;
}

// Paths on a line, at their number; a travel move across 4.5 crosses a wall.
TravelTotals OnALine(size_t, const Placement& from, const Placement& to) {
  TravelTotals travel;
  travel.mm = std::abs(static_cast<double>(from.block) - static_cast<double>(to.block));
  travel.seconds = travel.mm;
  travel.crossings = (from.block < 5) != (to.block < 5) ? 1 : 0;
  return travel;
}

TEST(OrderMerger, TakesTheRunsThatAreBetter) {
  const TravelEstimate estimate = OnALine;
  const OrderMerger merger(estimate, {});
  const LayerOrder left = OrderOf({0, 1, 2, 3, 4, 5, 8, 6, 7, 9});
  const LayerOrder right = OrderOf({0, 3, 1, 4, 2, 5, 6, 7, 8, 9});

  EXPECT_EQ(merger.Merge(left, {right}), OrderOf({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(merger.Merge(right, {left}), OrderOf({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(OrderMerger, EndsOnceNoRunIsBetter) {
  size_t asked = 0;
  const TravelEstimate estimate = [&](size_t position, const Placement& from, const Placement& to) {
    ++asked;
    return OnALine(position, from, to);
  };
  const OrderMerger merger(estimate, {});
  const LayerOrder best = OrderOf({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});

  EXPECT_EQ(merger.Merge(best, {OrderOf({0, 3, 1, 4, 2, 5, 6, 7, 8, 9})}), best);
  EXPECT_LT(asked, 200);  // of 20,000
}

TEST(OrderMerger, OfAnOrderThatMayNotBeItTakesWhatMay) {
  const TravelEstimate estimate = OnALine;
  MergeLimits limits;
  limits.crossings = 1;
  const OrderMerger merger(estimate, limits);
  const LayerOrder given = OrderOf({0, 3, 1, 2, 4, 5, 8, 6, 7, 9});
  const LayerOrder quick = OrderOf({0, 1, 2, 3, 5, 4, 6, 7, 8, 9});

  const LayerOrder merged = merger.Merge(quick, {given});

  EXPECT_EQ(merger.Excess(merger.TotalsOf(quick)), 2);
  EXPECT_EQ(merger.Excess(merger.TotalsOf(merged)), 0);
  EXPECT_EQ(merged, OrderOf({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

// Where only the number of the file's retractions will do, fewer are as far off as more.
TEST(OrderMerger, AsManyRetractionsMeansNoFewerEither) {
  const TravelEstimate estimate = OnALine;
  MergeLimits limits;
  limits.retractions = 4;
  TravelTotals totals;
  const auto excess = [&](int32_t retractions) {
    totals.retractions = retractions;
    return OrderMerger(estimate, limits).Excess(totals);
  };
  EXPECT_EQ(excess(2), 0);
  EXPECT_EQ(excess(6), 2);
  limits.least_retractions = limits.retractions;
  EXPECT_EQ(excess(2), 2);
  EXPECT_EQ(excess(4), 0);
  EXPECT_EQ(excess(6), 2);
}

TEST(OrderMerger, EntriesComeFromTheOrdersToo) {
  const TravelEstimate estimate = [](size_t, const Placement& from, const Placement& to) {
    TravelTotals travel;
    travel.seconds = 10 - from.entry - to.entry;
    return travel;
  };
  const OrderMerger merger(estimate, {});
  LayerOrder other = OrderOf({0, 1, 2, 3});
  other[1].entry = 1;
  other[3].entry = 1;  // the last path stays as it is

  LayerOrder wanted = OrderOf({0, 1, 2, 3});
  wanted[1].entry = 1;
  EXPECT_EQ(merger.Merge(OrderOf({0, 1, 2, 3}), {other}), wanted);
}

// A random order in which i comes before i + 3 wherever `keeps`.
LayerOrder RandomOrder(size_t n, const std::vector<bool>& keeps, Rng& rng) {
  std::vector<uint32_t> left(n);
  for (uint32_t i = 0; i < n; ++i) left[i] = i;
  std::vector<uint32_t> order;
  while (!left.empty()) {
    const size_t at = rng.Below(static_cast<uint32_t>(left.size()));
    const uint32_t block = left[at];
    const bool waits =
        block >= 3 && keeps[block] && std::find(left.begin(), left.end(), block - 3) != left.end();
    if (waits) continue;
    order.push_back(block);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
  }
  return OrderOf(order);
}

TEST(OrderMerger, KeepsWhatAllAgreeOnAndNeverGetsWorse) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const size_t n = 3 + rng.Below(60);
    std::vector<bool> keeps(n);
    for (size_t i = 0; i < n; ++i) keeps[i] = rng.Below(2) == 0;
    const TravelEstimate estimate = OnALine;
    MergeLimits limits;
    limits.crossings = static_cast<int64_t>(rng.Below(6));
    const OrderMerger merger(estimate, limits);
    const LayerOrder begun = RandomOrder(n, keeps, rng);

    const LayerOrder merged = merger.Merge(
        begun,
        {RandomOrder(n, keeps, rng), RandomOrder(n, keeps, rng), RandomOrder(n, keeps, rng)});

    std::vector<size_t> place(n, n);
    for (size_t i = 0; i < n; ++i) place[merged[i].block] = i;
    for (size_t i = 0; i < n; ++i) {
      ASSERT_LT(place[i], n);
      if (i >= 3 && keeps[i]) {
        EXPECT_LT(place[i - 3], place[i]);
      }
    }
    EXPECT_EQ(merged.front(), begun.front());
    EXPECT_EQ(merged.back(), begun.back());
    const TravelTotals was = merger.TotalsOf(begun);
    const TravelTotals is = merger.TotalsOf(merged);
    EXPECT_LE(merger.Excess(is), merger.Excess(was));
    if (merger.Excess(was) == 0) {
      EXPECT_LE(merger.Score(is), merger.Score(was));
    }
  }
}

TEST(OrderMerger, WhatIsNoBetterStaysAsItWasBegun) {
  const TravelEstimate estimate = [](size_t, const Placement&, const Placement&) {
    TravelTotals travel;
    travel.seconds = 1;
    return travel;
  };
  const OrderMerger merger(estimate, {});

  EXPECT_EQ(merger.Merge(OrderOf({0, 1, 2, 3}), {OrderOf({0, 2, 1, 3})}), OrderOf({0, 1, 2, 3}));
}

TEST(OrderMerger, KnowsPathsByTheirNumbersInTheFile) {
  const auto from_1000 = [](const LayerOrder& order) {
    LayerOrder moved = order;
    for (Placement& placement : moved) placement.block += 1000;
    return moved;
  };
  const TravelEstimate estimate = OnALine;
  const OrderMerger merger(estimate, {});
  const LayerOrder left = OrderOf({0, 1, 2, 3, 4, 5, 8, 6, 7, 9});
  const LayerOrder right = OrderOf({0, 3, 1, 4, 2, 5, 6, 7, 8, 9});

  EXPECT_EQ(merger.Merge(from_1000(left), {from_1000(right)}),
            from_1000(OrderOf({0, 1, 2, 3, 4, 5, 6, 7, 8, 9})));
}

}  // namespace
}  // namespace traverse::gcode
