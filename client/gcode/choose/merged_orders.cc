#include "client/gcode/choose/merged_orders.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "client/gcode/choose/orders/order_state.h"

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
  if (rules.as_many_retractions) limits.retractions = limits.least_retractions = given.retractions;
  return limits;
}

bool EndsAlike(const LayerOrder& a, const LayerOrder& b) {
  return a.front() == b.front() && a.back() == b.back();
}

// The paths in the order of the file, begun as in `order`: where walls may change places, travel
// moves that are as long may have to be retracted that were open.
LayerOrder InGivenOrder(LayerOrder order) {
  std::ranges::sort(order, {}, &Placement::block);
  return order;
}

// Of what begins or ends elsewhere only the whole file tells whether it crosses too many walls.
MergeLimits AnyCrossings(MergeLimits limits) {
  limits.crossings = std::numeric_limits<int64_t>::max();
  limits.crossing_seconds = std::max(limits.crossing_seconds, kSparingCrossingSeconds);
  return limits;
}

}  // namespace

LayerMerge::LayerMerge(KnownTravels& travels, const MergeRules& rules)
    : writer_(travels.writer()),
      travels_(travels),
      rules_(rules),
      given_(writer_.GivenOrder()),
      were_(OrderMerger(estimate_, {}).TotalsOf(given_)),
      strict_(estimate_, LimitsOf(were_, rules)),
      quick_(estimate_, AnyCrossings(LimitsOf(were_, rules))) {
  if (!rules.freedom || !rules.polish) return;
  polisher_.emplace(given_.front().block, writer_.outlines(), *rules.freedom, estimate_,
                    *rules.polish);
}

std::vector<LayerOrder> LayerMerge::Merge(const LayerOrder& found) const {
  if (!IsWhole(found)) return {found};
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

// The file may have no retractions to spare.
void LayerMerge::AddSparing(const LayerOrder& found, std::vector<LayerOrder>& merged) const {
  const bool all_retract_more = std::all_of(merged.begin(), merged.end(), [&](const auto& order) {
    return strict_.TotalsOf(order).retractions > were_.retractions;
  });
  if (!all_retract_more || rules_.as_many_retractions) return;
  MergeLimits sparing = LimitsOf(were_, rules_);
  sparing.retractions = were_.retractions;
  LayerOrder order = Better(OrderMerger(estimate_, sparing), given_, {found}, Effort::kSettle);
  if (order != given_) merged.push_back(std::move(order));
}

LayerOrder LayerMerge::Improve(const LayerOrder& order, Effort effort) {
  if (!IsWhole(order)) return order;
  StandAs(order);
  return Better(strict_, order, {}, effort);
}

// Once with no more retractions than the file's own order; then with fewer at a price, which a
// search that is at its limit of crossings may come to where it cannot come within the first.
std::vector<LayerOrder> LayerMerge::Spare(const LayerOrder& order) {
  if (!IsWhole(order)) return {};
  StandAs(order);
  MergeLimits few = LimitsOf(were_, rules_);
  MergeLimits priced = EndsAlike(order, given_) ? few : AnyCrossings(few);
  few.retractions = were_.retractions;
  priced.retraction_seconds = kSparedRetractionSeconds;
  return {Better(OrderMerger(estimate_, few), order, {}, Effort::kKick),
          Better(OrderMerger(estimate_, priced), order, {}, Effort::kKick)};
}

LayerOrder LayerMerge::SettleWithin(const LayerOrder& order,
                                    const std::vector<uint32_t>& units) const {
  return polisher_->PolishWithin(units, order, quick_, Effort::kSettle);
}

TurnedLayer LayerMerge::Turn(std::vector<LayerOrder> orders, const TravelModel& travel,
                             const std::vector<std::vector<uint32_t>>& islands, double rest_seconds,
                             const std::vector<double>& moments) const {
  std::erase_if(orders, [this](const LayerOrder& order) { return !IsWhole(order); });
  // The same order comes up again where two orders of a layer differ only in the sequence of their
  // islands, and where no islands count as one.
  struct SettledOrder {
    LayerOrder order;
    std::vector<uint32_t> units;
    LayerOrder settled;
  };
  std::vector<SettledOrder> known;
  IslandTurns::Settle settle;
  if (polisher_) {
    settle = [&](const LayerOrder& order, const std::vector<uint32_t>& units) {
      for (const SettledOrder& before : known) {
        if (before.order == order && before.units == units) return before.settled;
      }
      known.push_back({order, units, SettleWithin(order, units)});
      return known.back().settled;
    };
  }
  TurnedLayer turned;
  turned.first_block = given_.front().block;
  turned.given = were_;
  turned.given_begin = BeginOf(OutlineOf(given_.front()), given_.front());
  turned.given_end = EndOf(OutlineOf(given_.back()), given_.back());
  turned.turns = IslandTurns(given_, orders, islands, rest_seconds, *rules_.freedom, estimate_,
                             quick_, ClockOf(moments, travel.speed_mm_s), settle);
  for (size_t turn = 0; turn < turned.turns.size(); ++turn) {
    const LayerOrder order = turned.turns.OrderOf(turn);
    turned.begin.push_back(BeginOf(OutlineOf(order.front()), order.front()));
    turned.end.push_back(EndOf(OutlineOf(order.back()), order.back()));
  }
  return turned;
}

// Travel takes as long in nominal time as in the file's own order, where `moments` are when its
// paths begin and end.
LayerClock LayerMerge::ClockOf(const std::vector<double>& moments, double mm_s) const {
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

std::optional<LayerOrder> LayerMerge::Repair(LayerOrder order, size_t reach) {
  if (!IsWhole(order)) return std::nullopt;
  StandAs(order);
  size_t repairs = 0;
  LayerOrder ordered = InOrderOf(order, given_.front().block, rules_.ordered);
  if (ordered != order && KeepsTogether(ordered)) {
    order = std::move(ordered);
    ++repairs;
  }
  for (size_t place = 1; place < order.size() && repairs < kMostRepairs; ++place) {
    if (!IsRefused(order[place - 1], order[place])) continue;
    std::optional<LayerOrder> best;
    for (LayerOrder& other : OrdersWithoutLink(order, place, given_, reach)) {
      if (!KeepsTogether(other)) continue;
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

// Each path of the layer once. What is not has to be found out when it is verified.
bool LayerMerge::IsWhole(const LayerOrder& order) const {
  std::vector<bool> has(given_.size());
  for (const Placement& placement : order) {
    const size_t path = placement.block - given_.front().block;
    if (path >= has.size() || has[path]) return false;
    has[path] = true;
  }
  return order.size() == given_.size();
}

// What comes directly behind the path before it still does.
bool LayerMerge::KeepsTogether(const LayerOrder& order) const {
  for (size_t place = 0; place < order.size(); ++place) {
    const uint32_t block = order[place].block;
    if (!rules_.freedom->goes_on[block - given_.front().block]) continue;
    if (place == 0 || order[place - 1].block + 1 != block) return false;
  }
  return true;
}

// `order` may have objects in other places than the file.
void LayerMerge::StandAs(const LayerOrder& order) { places_ = writer_.PlacesOf(order); }

// The rules refuse that link.
bool LayerMerge::IsRefused(const Placement& from, const Placement& to) const {
  return rules_.refused != nullptr && rules_.refused->contains({from, to});
}

// See TravelEstimate.
TravelTotals LayerMerge::TravelTo(size_t place, const Placement& from, const Placement& to) const {
  if (!places_.empty()) place = places_[place];
  TravelTotals totals = travels_(place, from, to);
  if (IsRefused(from, to) && !travels_.IsAsGiven(place, from, to)) ++totals.too_long;
  return totals;
}

LayerOrder LayerMerge::Better(const OrderMerger& judge, const LayerOrder& order,
                              const std::vector<LayerOrder>& others, Effort effort) const {
  const LayerOrder merged = others.empty() ? order : judge.Merge(order, others);
  return polisher_ ? polisher_->Polish(merged, judge, effort) : merged;
}

std::pair<double, double> LayerMerge::Rank(const LayerOrder& order) const {
  const TravelTotals totals = strict_.TotalsOf(order);
  return {strict_.Excess(totals), strict_.Score(totals)};
}

}  // namespace traverse::gcode
