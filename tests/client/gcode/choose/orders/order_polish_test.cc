// Orders made better by small moves: client/gcode/choose/orders/order_polish.h.

#include "client/gcode/choose/orders/order_polish.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include "engine/base/rng.h"

namespace traverse::gcode {
namespace {

constexpr uint32_t kFirst = 7;

// The paths of a layer, and what may change in it.
struct PolishedLayer {
  std::vector<Outline> outlines;
  LayerFreedom freedom;

  void Add(std::vector<Point> points, const PathRule& rule) {
    Outline& outline = outlines.emplace_back();
    outline.points = std::move(points);
    outline.closed = rule.contour;
    freedom.rules.push_back(rule);
    freedom.group.push_back(0);
    freedom.goes_on.push_back(false);
  }

  // A line to the right, 1 mm long.
  void AddLine(double x, double y, bool one_way = true) {
    PathRule rule;
    rule.one_way = one_way;
    Add({{x, y}, {x + 1, y}}, rule);
  }

  LayerOrder Given() const {
    LayerOrder order;
    for (uint32_t i = 0; i < outlines.size(); ++i) {
      order.push_back({kFirst + i, 0, outlines[i].closed});
    }
    return order;
  }

  Point End(const Placement& at, bool begin) const {
    const std::vector<Point>& points = outlines[at.block - kFirst].points;
    if (at.closed) return points[at.entry];
    return (at.entry == 0) == begin ? points.front() : points.back();
  }

  // As long as the travel is.
  TravelTotals Length(const Placement& from, const Placement& to) const {
    TravelTotals travel;
    travel.mm = travel.seconds = Distance(End(from, false), End(to, true));
    return travel;
  }

  LayerOrder Polished(const LayerOrder& begun, const MergeLimits& limits = {},
                      const PolishLimit& limit = {}) const {
    const TravelEstimate estimate = [this](size_t, const Placement& from, const Placement& to) {
      return Length(from, to);
    };
    return OrderPolisher(kFirst, outlines, freedom, estimate, limit)
        .Polish(begun, OrderMerger(estimate, limits), OrderPolisher::Effort::kSettle);
  }
};

std::vector<uint32_t> PathsOf(const LayerOrder& order) {
  std::vector<uint32_t> paths;
  for (const Placement& placement : order) paths.push_back(placement.block - kFirst);
  return paths;
}

TEST(OrderPolisher, BringsPathsWhereTheyLie) {
  PolishedLayer sheet;
  for (const double x : {0.0, 10.0, 6.0, 2.0, 8.0, 4.0, 12.0}) sheet.AddLine(x, 0);

  EXPECT_EQ(PathsOf(sheet.Polished(sheet.Given())), (std::vector<uint32_t>{0, 3, 5, 2, 4, 1, 6}));
}

TEST(OrderPolisher, KeepsPathsInTheGroupsThatItIsGiven) {
  PolishedLayer sheet;
  for (const double x : {0.0, 10.0, 6.0, 2.0, 8.0, 4.0, 12.0}) sheet.AddLine(x, 0);
  const TravelEstimate estimate = [&sheet](size_t, const Placement& from, const Placement& to) {
    return sheet.Length(from, to);
  };
  const PolishLimit limit;
  const OrderPolisher polisher(kFirst, sheet.outlines, sheet.freedom, estimate, limit);
  const LayerOrder polished =
      polisher.PolishWithin({0, 0, 0, 0, 1, 1, 1}, sheet.Given(), OrderMerger(estimate, {}),
                            OrderPolisher::Effort::kSettle);

  EXPECT_EQ(PathsOf(polished), (std::vector<uint32_t>{0, 3, 2, 1, 5, 4, 6}));
}

TEST(OrderPolisher, TurnsRoundWhatMayBeTurned) {
  PolishedLayer sheet;
  for (int i = 0; i < 6; ++i) sheet.AddLine(0, i, false);
  const LayerOrder polished = sheet.Polished(sheet.Given());

  // There and back by turns, but for the first one and the last.
  for (size_t i = 1; i < 5; ++i) EXPECT_EQ(polished[i].entry, i % 2) << i;
}

TEST(OrderPolisher, BeginsClosedPathsWhereTheyAreComeTo) {
  PolishedLayer sheet;
  sheet.AddLine(0, 0);
  PathRule loop;
  loop.contour = true;
  sheet.Add({{50, 0}, {50, 9}, {5, 9}, {5, 0}, {50, 0}}, loop);
  loop.entries = {0, 1, 2};
  sheet.Add({{50, 10}, {50, 19}, {5, 19}, {5, 10}, {50, 10}}, loop);
  sheet.AddLine(6, 20);

  const LayerOrder polished = sheet.Polished(sheet.Given());

  EXPECT_EQ(PathsOf(polished), (std::vector<uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(polished[1].entry, 2u);  // between the line and what follows
  EXPECT_EQ(polished[2].entry, 2u);  // 3 is nearer and not allowed
}

// A travel move to the left is dear: no search that takes both directions for the same sees that.
TEST(OrderPolisher, KnowsTheDirectionOfTravels) {
  PolishedLayer sheet;
  for (int i = 0; i < 8; ++i) sheet.AddLine(3 * i, 0, false);
  const TravelEstimate estimate = [&](size_t, const Placement& from, const Placement& to) {
    TravelTotals travel = sheet.Length(from, to);
    if (sheet.End(to, true).x < sheet.End(from, false).x) travel.seconds += 1;
    return travel;
  };
  const OrderMerger judge(estimate, {});
  LayerOrder begun = sheet.Given();
  std::reverse(begun.begin() + 1, begun.end() - 1);

  const PolishLimit limit;
  const LayerOrder polished = OrderPolisher(kFirst, sheet.outlines, sheet.freedom, estimate, limit)
                                  .Polish(begun, judge, OrderPolisher::Effort::kKick);

  EXPECT_EQ(polished, sheet.Given());
}

TEST(OrderPolisher, FirstKeepsToTheLimits) {
  PolishedLayer sheet;
  for (const double x : {0.0, 4.0, 2.0, 6.0}) sheet.AddLine(x, 0);
  const TravelEstimate estimate = [&](size_t, const Placement& from, const Placement& to) {
    TravelTotals travel = sheet.Length(from, to);
    travel.crossings = from.block + 2 == to.block ? 1 : 0;
    return travel;
  };
  MergeLimits limits;
  limits.crossings = 0;

  const PolishLimit limit;
  const LayerOrder polished =
      OrderPolisher(kFirst, sheet.outlines, sheet.freedom, estimate, limit)
          .Polish(sheet.Given(), OrderMerger(estimate, limits), OrderPolisher::Effort::kKick);

  EXPECT_EQ(polished, sheet.Given());  // 0 2 1 3 is shorter and crosses twice
}

// A layer as it may be: groups, units, pairs that keep their order, lines and loops.
PolishedLayer RandomLayer(Rng& rng) {
  PolishedLayer sheet;
  const size_t n = 3 + rng.Below(40);
  uint32_t group = 0;
  for (size_t i = 0; i < n; ++i) {
    const double x = rng.Below(50);
    const double y = rng.Below(50);
    if (rng.Below(3) == 0) {
      PathRule rule;
      rule.contour = true;
      if (rng.Below(2) == 0) rule.entries = {0, 2};
      sheet.Add({{x, y}, {x + 3, y}, {x + 3, y + 3}, {x, y + 3}, {x, y}}, rule);
    } else {
      sheet.AddLine(x, y, rng.Below(2) == 0);
    }
    if (rng.Below(12) == 0) group = static_cast<uint32_t>(i);
    sheet.freedom.group[i] = group;
  }
  for (size_t i = 1; i < n; ++i) {
    sheet.freedom.goes_on[i] =
        sheet.freedom.group[i] == sheet.freedom.group[i - 1] && rng.Below(6) == 0;
  }
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = i + 1; j < n; ++j) {
      if (rng.Below(20) == 0) sheet.freedom.ordered.emplace_back(i, j);
    }
  }
  return sheet;
}

void ExpectAllowed(const PolishedLayer& sheet, const LayerOrder& order) {
  const std::vector<uint32_t> paths = PathsOf(order);
  const LayerFreedom& freedom = sheet.freedom;
  ASSERT_EQ(std::set<uint32_t>(paths.begin(), paths.end()).size(), sheet.outlines.size());
  std::vector<size_t> place(paths.size());
  for (size_t i = 0; i < paths.size(); ++i) place[paths[i]] = i;
  for (const auto& [first, second] : freedom.ordered) EXPECT_LT(place[first], place[second]);
  for (size_t i = 0; i < paths.size(); ++i) {
    const uint32_t path = paths[i];
    const PathRule& rule = freedom.rules[path];
    EXPECT_EQ(freedom.group[path], freedom.group[i]);
    if (freedom.goes_on[path]) {
      EXPECT_EQ(place[path], place[path - 1] + 1);
    }
    if (!rule.contour) {
      EXPECT_LE(order[i].entry, rule.one_way ? 0u : 1u);
    } else if (!rule.entries.empty()) {
      EXPECT_NE(std::find(rule.entries.begin(), rule.entries.end(), order[i].entry),
                rule.entries.end());
    } else {
      EXPECT_LT(order[i].entry, 4u);
    }
  }
}

TEST(OrderPolisher, DoesWhatThePlanAllowsAndNeverGetsWorse) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const PolishedLayer sheet = RandomLayer(rng);
    const LayerOrder given = sheet.Given();
    const TravelEstimate estimate = [&](size_t, const Placement& from, const Placement& to) {
      TravelTotals travel = sheet.Length(from, to);
      travel.crossings = (from.block * 7 + to.block * 3) % 5 == 0 ? 1 : 0;
      travel.seconds += (from.block + 2 * to.entry) % 4;
      return travel;
    };
    MergeLimits limits;
    limits.crossings = static_cast<int64_t>(rng.Below(8));
    const OrderMerger judge(estimate, limits);

    const PolishLimit limit;
    const LayerOrder polished =
        OrderPolisher(kFirst, sheet.outlines, sheet.freedom, estimate, limit)
            .Polish(given, judge, OrderPolisher::Effort::kKick);

    ExpectAllowed(sheet, polished);
    EXPECT_EQ(polished.front(), given.front());
    EXPECT_EQ(polished.back(), given.back());
    const TravelTotals was = judge.TotalsOf(given);
    const TravelTotals is = judge.TotalsOf(polished);
    EXPECT_LE(judge.Excess(is), judge.Excess(was));
    if (judge.Excess(was) == judge.Excess(is)) {
      EXPECT_LE(judge.Score(is), judge.Score(was) + 1e-6);
    }
  }
}

TEST(OrderPolisher, EndsAtItsLimit) {
  PolishedLayer sheet;
  for (const double x : {0.0, 10.0, 6.0, 2.0, 8.0, 4.0, 12.0}) sheet.AddLine(x, 0);
  std::stop_source stop;
  ASSERT_NE(
      sheet.Polished(sheet.Given(), {}, {WorkLimit(absl::InfiniteFuture(), stop.get_token())}),
      sheet.Given());
  stop.request_stop();

  EXPECT_EQ(
      sheet.Polished(sheet.Given(), {}, {WorkLimit(absl::InfiniteFuture(), stop.get_token())}),
      sheet.Given());
  EXPECT_EQ(sheet.Polished(sheet.Given(), {}, {WorkLimit(absl::InfinitePast(), {})}),
            sheet.Given());
}

TEST(OrderPolisher, KicksFindWhatNoSingleChangeDoes) {
  int better = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    PolishedLayer sheet;
    for (int i = 0; i < 40; ++i) sheet.AddLine(rng.Below(60), rng.Below(60), false);
    const TravelEstimate estimate = [&](size_t, const Placement& from, const Placement& to) {
      return sheet.Length(from, to);
    };
    const OrderMerger judge(estimate, {});
    const PolishLimit limit;
    const OrderPolisher polisher(kFirst, sheet.outlines, sheet.freedom, estimate, limit);
    const auto length = [&](OrderPolisher::Effort effort) {
      return judge.TotalsOf(polisher.Polish(sheet.Given(), judge, effort)).mm;
    };
    const double settled = length(OrderPolisher::Effort::kSettle);
    const double kicked = length(OrderPolisher::Effort::kKick);
    EXPECT_LE(kicked, settled + 1e-9) << seed;
    better += kicked < settled - 1e-6 ? 1 : 0;
  }
  EXPECT_GE(better, 5);
}

TEST(OrderPolisher, GivesUpSoonerWhereEstimatesTakeLonger) {
  const auto asked = [](double seconds_per_travel) {
    size_t count = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
      Rng rng(seed);
      PolishedLayer sheet;
      for (int i = 0; i < 40; ++i) sheet.AddLine(rng.Below(60), rng.Below(60), false);
      const TravelEstimate estimate = [&](size_t, const Placement& from, const Placement& to) {
        ++count;
        return sheet.Length(from, to);
      };
      PolishLimit limit;
      limit.seconds_per_travel = seconds_per_travel;
      OrderPolisher(kFirst, sheet.outlines, sheet.freedom, estimate, limit)
          .Polish(sheet.Given(), OrderMerger(estimate, {}), OrderPolisher::Effort::kKick);
    }
    return count;
  };

  EXPECT_GT(asked(PolishLimit::kSecondsPerTravel), asked(1));
}

TEST(OrderPolisher, OfTwoPathsNothingCanBeChanged) {
  PolishedLayer sheet;
  sheet.AddLine(0, 0, false);
  sheet.AddLine(5, 0, false);

  EXPECT_EQ(sheet.Polished(sheet.Given()), sheet.Given());
  EXPECT_TRUE(sheet.Polished({}).empty());
}

}  // namespace
}  // namespace traverse::gcode
