#include "client/gcode/choose/merged_orders.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "client/gcode/choose/order_state.h"

namespace traverse::gcode {
namespace {

// What a crossing counts where an order may have more of them than the file: some layers are to
// have fewer, so that others may have more.
constexpr double kSparingCrossingSeconds = 0.25;

// What a retraction counts in orders that are to have fewer.
constexpr double kSparedRetractionSeconds = 1;

// Refused links that are taken out of an order at once, for each asks for all travel moves of the
// layer.
constexpr size_t kMostRepairs = 64;

MergeLimits LimitsOf(const TravelTotals& given, const MergeRules& rules) {
  MergeLimits limits;
  if (rules.crossings != Crossings::kAny) limits.crossings = given.crossings;
  if (rules.crossings == Crossings::kFewer) limits.crossing_seconds = kFewerCrossingSeconds;
  limits.open = given.open;
  if (rules.as_many_retractions) {
    limits.retractions = given.retractions;
    limits.as_many_retractions = true;
  }
  return limits;
}

// Each path of the layer once. What is not has to be found out when it is verified.
bool IsWhole(const LayerOrder& order, const LayerOrder& given) {
  std::vector<bool> has(given.size());
  for (const Placement& placement : order) {
    const size_t path = placement.block - given.front().block;
    if (path >= has.size() || has[path]) return false;
    has[path] = true;
  }
  return order.size() == given.size();
}

// What comes directly behind the path before it still does.
bool KeepsTogether(const LayerOrder& order, const LayerFreedom& freedom, uint32_t first) {
  for (size_t place = 0; place < order.size(); ++place) {
    const uint32_t block = order[place].block;
    if (!freedom.goes_on[block - first]) continue;
    if (place == 0 || order[place - 1].block + 1 != block) return false;
  }
  return true;
}

bool EndsAlike(const LayerOrder& a, const LayerOrder& b) {
  return a.front() == b.front() && a.back() == b.back();
}

// The paths in the order of the file, begun as in `order`: where walls may change places, travel
// moves that are as long may have to be retracted that were open.
LayerOrder InGivenOrder(LayerOrder order) {
  std::sort(order.begin(), order.end(),
            [](const Placement& a, const Placement& b) { return a.block < b.block; });
  return order;
}

// Of what begins or ends elsewhere only the whole file tells whether it crosses too many walls.
MergeLimits AnyCrossings(MergeLimits limits) {
  limits.crossings = std::numeric_limits<int64_t>::max();
  limits.crossing_seconds = std::max(limits.crossing_seconds, kSparingCrossingSeconds);
  return limits;
}

// One layer whose orders are merged.
class LayerMerge {
 public:
  using Effort = OrderPolisher::Effort;

  LayerMerge(KnownTravels& travels, const MergeRules& rules)
      : writer_(travels.writer()),
        travels_(travels),
        rules_(rules),
        given_(writer_.GivenOrder()),
        were_(OrderMerger(estimate_, {}).TotalsOf(given_)),
        strict_(estimate_, LimitsOf(were_, rules)),
        quick_(estimate_, AnyCrossings(LimitsOf(were_, rules))) {
    if (!rules.freedom) return;
    polisher_.emplace(given_.front().block, writer_.outlines(), *rules.freedom, estimate_,
                      *rules.polish);
  }

  std::vector<LayerOrder> Merge(const LayerOrder& found) const {
    const std::vector<LayerOrder> all = {found, given_};
    std::vector<LayerOrder> begun = {found};
    if (IsFree(rules_.policy)) begun.push_back(InGivenOrder(found));
    LayerOrder best_between = Better(strict_, given_, {found}, Effort::kSettle);
    std::vector<LayerOrder> merged;
    for (const LayerOrder& order : begun) {
      merged.push_back(Better(quick_, order, all, Effort::kSettle));
      LayerOrder better = Better(strict_, order, all, Effort::kSettle);
      if (!EndsAlike(order, given_)) {
        merged.push_back(std::move(better));
      } else if (Rank(better) < Rank(best_between)) {
        best_between = std::move(better);
      }
    }
    if (best_between != given_) merged.push_back(std::move(best_between));
    AddSparing(found, merged);
    return merged;
  }

  LayerOrder Improve(const LayerOrder& order, Effort effort) {
    StandAs(order);
    return Better(strict_, order, {}, effort);
  }

  // `order` with no more retractions than the file's own; then with fewer at a price, which a
  // search that is at its limit of crossings may come to where it cannot come within the first.
  std::vector<LayerOrder> Spare(const LayerOrder& order) {
    StandAs(order);
    MergeLimits few = LimitsOf(were_, rules_);
    MergeLimits priced = EndsAlike(order, given_) ? few : AnyCrossings(few);
    few.retractions = were_.retractions;
    priced.retraction_seconds = kSparedRetractionSeconds;
    return {Better(OrderMerger(estimate_, few), order, {}, Effort::kKick),
            Better(OrderMerger(estimate_, priced), order, {}, Effort::kKick)};
  }

  // See TurnedOrders.
  TurnedLayer Turn(const std::vector<LayerOrder>& orders, const LayerFreedom& freedom,
                   const std::vector<std::vector<uint32_t>>& islands, double rest_seconds,
                   LayerClock clock) const {
    TurnedLayer turned;
    turned.first_block = given_.front().block;
    turned.given = were_;
    turned.given_begin = BeginOf(given_.front());
    turned.given_end = EndOf(given_.back());
    std::vector<SettledOrder> settled;
    IslandTurns::Settle settle;
    if (rules_.freedom) {
      settle = [&](const LayerOrder& order, const std::vector<uint32_t>& units) {
        return SettleOnce(order, units, settled);
      };
    }
    turned.turns = IslandTurns(given_, orders, islands, rest_seconds, freedom, estimate_, quick_,
                               std::move(clock), settle);
    for (size_t turn = 0; turn < turned.turns.size(); ++turn) {
      turned.begin.push_back(BeginOf(turned.turns.FirstOf(turn)));
      turned.end.push_back(EndOf(turned.turns.LastOf(turn)));
    }
    return turned;
  }

  // What an order within `units` became.
  struct SettledOrder {
    LayerOrder order;
    std::vector<uint32_t> units;
    LayerOrder settled;
  };

  // The same order comes up again where two orders of a layer differ only in the sequence of their
  // islands, and where no islands count as one.
  LayerOrder SettleOnce(const LayerOrder& order, const std::vector<uint32_t>& units,
                        std::vector<SettledOrder>& known) const {
    for (const SettledOrder& before : known) {
      if (before.order == order && before.units == units) return before.settled;
    }
    known.push_back({order, units, SettleWithin(order, units)});
    return known.back().settled;
  }

  // See SettledWithin.
  LayerOrder SettleWithin(const LayerOrder& order, const std::vector<uint32_t>& units) const {
    return polisher_->PolishWithin(units, order, quick_, Effort::kSettle);
  }

  // Travel takes as long in nominal time as in the file's own order, where `moments` are when its
  // paths begin and end.
  LayerClock ClockOf(const std::vector<double>& moments, double mm_s) const {
    LayerClock clock;
    clock.travel_mm_s = mm_s;
    double travel_seconds = 0;
    for (size_t path = 0; path < given_.size(); ++path) {
      clock.path_seconds.push_back(moments[2 * path + 1] - moments[2 * path]);
      if (path > 0) travel_seconds += moments[2 * path] - moments[2 * path - 1];
    }
    const double beside = travel_seconds - were_.mm / mm_s;
    if (were_.retractions > 0) {
      clock.retraction_seconds = std::max(beside, 0.0) / static_cast<double>(were_.retractions);
    }
    return clock;
  }

  // See RepairedOrder.
  std::optional<LayerOrder> Repair(LayerOrder order, const LayerFreedom& freedom, size_t reach) {
    StandAs(order);
    size_t repairs = 0;
    const uint32_t first = given_.front().block;
    LayerOrder ordered = InOrderOf(order, first, rules_.ordered);
    if (ordered != order && KeepsTogether(ordered, freedom, first)) {
      order = std::move(ordered);
      ++repairs;
    }
    for (size_t place = 1; place < order.size() && repairs < kMostRepairs; ++place) {
      if (!IsRefused(order[place - 1], order[place])) continue;
      std::optional<LayerOrder> best;
      for (LayerOrder& other : OrdersWithoutLink(order, place, given_, reach)) {
        if (!KeepsTogether(other, freedom, given_.front().block)) continue;
        const bool better =
            !best || strict_.IsBetter(strict_.TotalsOf(other), strict_.TotalsOf(*best));
        if (better) best = std::move(other);
      }
      if (!best) continue;
      order = *std::move(best);
      ++repairs;
    }
    return repairs > 0 ? std::optional(std::move(order)) : std::nullopt;
  }

 private:
  // `order` may have objects in other places than the file.
  void StandAs(const LayerOrder& order) { places_ = writer_.PlacesOf(order); }

  // The rules refuse that link.
  bool IsRefused(const Placement& from, const Placement& to) const {
    return rules_.refused != nullptr && rules_.refused->contains({from, to});
  }

  // See TravelEstimate.
  TravelTotals TravelTo(size_t place, const Placement& from, const Placement& to) const {
    if (!places_.empty()) place = places_[place];
    TravelTotals totals = travels_(place, from, to);
    if (IsRefused(from, to) && !travels_.IsAsGiven(place, from, to)) ++totals.too_long;
    return totals;
  }

  Point BeginOf(const Placement& placement) const {
    const size_t path = placement.block - given_.front().block;
    const std::vector<Point>& points = writer_.outlines()[path].points;
    if (placement.closed) return points[placement.entry];
    return placement.as_given() ? points.front() : points.back();
  }

  Point EndOf(const Placement& placement) const { return BeginOf(OrderState::Turned(placement)); }

  LayerOrder Better(const OrderMerger& judge, const LayerOrder& order,
                    const std::vector<LayerOrder>& others, Effort effort) const {
    const LayerOrder merged = others.empty() ? order : judge.Merge(order, others);
    return polisher_ ? polisher_->Polish(merged, judge, effort) : merged;
  }

  std::pair<double, double> Rank(const LayerOrder& order) const {
    const TravelTotals totals = strict_.TotalsOf(order);
    return {strict_.Excess(totals), strict_.Score(totals)};
  }

  // The file may have no retractions to spare.
  void AddSparing(const LayerOrder& found, std::vector<LayerOrder>& merged) const {
    const bool all_retract_more = std::all_of(merged.begin(), merged.end(), [&](const auto& order) {
      return strict_.TotalsOf(order).retractions > were_.retractions;
    });
    if (!all_retract_more || rules_.as_many_retractions) return;
    MergeLimits sparing = LimitsOf(were_, rules_);
    sparing.retractions = were_.retractions;
    LayerOrder order = Better(OrderMerger(estimate_, sparing), given_, {found}, Effort::kSettle);
    if (order != given_) merged.push_back(std::move(order));
  }

  const LayerWriter& writer_;
  KnownTravels& travels_;
  const MergeRules& rules_;
  const LayerOrder given_;
  std::vector<uint32_t> places_;  // [place] of the orders asked about, in the file; empty: the same
  const TravelEstimate estimate_ = [this](size_t place, const Placement& from,
                                          const Placement& to) {
    return TravelTo(place, from, to);
  };
  const TravelTotals were_;
  const OrderMerger strict_;  // keeps to what holds for the layer
  const OrderMerger quick_;   // but for its crossings
  std::optional<OrderPolisher> polisher_;
};

}  // namespace

MergeRules RulesUnder(const GcodeFile& file, const Layer& layer, Policy policy,
                      const Allowance& allow, const std::optional<PolishLimit>& polish) {
  MergeRules rules;
  rules.policy = policy;
  rules.polish = polish;
  if (polish) rules.freedom = FreedomOf(file, layer, policy, allow);
  return rules;
}

std::vector<LayerOrder> MergedOrders(KnownTravels& travels, const LayerOrder& found,
                                     const MergeRules& rules) {
  if (!IsWhole(found, travels.writer().GivenOrder())) return {found};
  return LayerMerge(travels, rules).Merge(found);
}

std::optional<LayerOrder> RepairedOrder(KnownTravels& travels, const LayerOrder& order,
                                        const MergeRules& rules, const LayerFreedom& freedom,
                                        size_t reach) {
  if (!IsWhole(order, travels.writer().GivenOrder())) return std::nullopt;
  return LayerMerge(travels, rules).Repair(order, freedom, reach);
}

TurnedLayer TurnedOrders(KnownTravels& travels, const TravelModel& travel,
                         const std::vector<LayerOrder>& orders, const MergeRules& rules,
                         const LayerFreedom& freedom,
                         const std::vector<std::vector<uint32_t>>& islands, double rest_seconds,
                         const std::vector<double>& moments) {
  std::vector<LayerOrder> whole;
  for (const LayerOrder& order : orders) {
    if (IsWhole(order, travels.writer().GivenOrder())) whole.push_back(order);
  }
  const LayerMerge merge(travels, rules);
  return merge.Turn(whole, freedom, islands, rest_seconds,
                    merge.ClockOf(moments, travel.speed_mm_s));
}

LayerOrder SettledWithin(KnownTravels& travels, const LayerOrder& order, const MergeRules& rules,
                         const std::vector<uint32_t>& units) {
  return LayerMerge(travels, rules).SettleWithin(order, units);
}

std::vector<LayerOrder> SettledOrders(KnownTravels& travels, std::vector<LayerOrder> orders,
                                      const MergeRules& rules) {
  LayerMerge merge(travels, rules);
  for (LayerOrder& order : orders) {
    if (!IsWhole(order, travels.writer().GivenOrder())) continue;
    order = merge.Improve(order, OrderPolisher::Effort::kSettle);
  }
  return orders;
}

LayerOrder KickedOrder(KnownTravels& travels, const LayerOrder& order, const MergeRules& rules) {
  if (!IsWhole(order, travels.writer().GivenOrder())) return order;
  return LayerMerge(travels, rules).Improve(order, OrderPolisher::Effort::kKick);
}

std::vector<LayerOrder> SparingOrders(KnownTravels& travels, const LayerOrder& order,
                                      const MergeRules& rules) {
  if (!IsWhole(order, travels.writer().GivenOrder())) return {};
  return LayerMerge(travels, rules).Spare(order);
}

}  // namespace traverse::gcode
