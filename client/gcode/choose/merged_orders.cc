#include "client/gcode/choose/merged_orders.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/choose/island_orders.h"

namespace traverse::gcode {
namespace {

// What a crossing counts where an order may have more of them than the file: some layers are to
// have fewer, so that others may have more.
constexpr double kSparingCrossingSeconds = 0.25;

// What a retraction counts in orders that are to have fewer.
constexpr double kSparedRetractionSeconds = 1;

// Rounding of sums of lengths.
constexpr double kSlackMm = 1e-6;

// Refused links that are taken out of an order at once, for each asks for all travel moves of the
// layer.
constexpr size_t kMostRepairs = 64;

MergeLimits LimitsOf(const TravelTotals& given, const MergeRules& rules) {
  MergeLimits limits;
  if (rules.crossings != Crossings::kAny) limits.crossings = given.crossings;
  if (rules.crossings == Crossings::kFewer) limits.crossing_seconds = kFewerCrossingSeconds;
  limits.open = given.open;
  if (rules.policy == Policy::kSafe) limits.mm = given.mm;
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

// The travel moves of a layer. Those around walls take long to find, and the same few are asked for
// again and again.
class KnownTravels {
 public:
  KnownTravels(const LayerWriter& writer, const TravelModel& travel, const MergeRules& rules)
      : writer_(writer), travel_(travel), rules_(rules), given_(writer.GivenOrder()) {
    uint32_t placements = 0;
    for (const Outline& outline : writer.outlines()) {
      numbers_.push_back(placements);
      placements += static_cast<uint32_t>(std::max<size_t>(outline.points.size(), 2));
    }
    given_travels_.resize(given_.size());
    for (size_t i = 1; i < given_.size(); ++i) {
      given_travels_[i] = writer.EstimateTravel(i, given_[i - 1], given_[i], travel);
      longest_open_mm_ = std::max(longest_open_mm_, given_travels_[i].open_mm);
    }
  }

  bool IsRefused(const Placement& from, const Placement& to) const {
    return rules_.refused != nullptr && rules_.refused->contains({from, to});
  }

  // From now on the orders asked about have objects in other places than the file.
  void MoveObjects() { moved_ = !rules_.places.empty(); }

  TravelTotals operator()(size_t place, const Placement& from, const Placement& to) {
    if (moved_) place = rules_.places[place];
    // Where something stands in the file, the travel depends on what that is.
    const bool boundary = rules_.boundaries[place];
    const size_t next = to.block - given_.front().block;
    const bool as_given = next > 0 && from == given_[next - 1] && to == given_[next];
    const bool alike = next == place || !(boundary || rules_.boundaries[next]);
    if (as_given && alike) return given_travels_[next];
    if (known_.size() >= kMostKnown) known_.clear();
    const Key key{boundary ? static_cast<uint32_t>(place) : 0, Number(from), Number(to)};
    const auto [found, added] = known_.try_emplace(key);
    if (added) found->second = Estimate(place, from, to);
    return found->second;
  }

 private:
  using Key = std::tuple<uint32_t, uint32_t, uint32_t>;

  // Of 56 bytes each.
  static constexpr size_t kMostKnown = 400'000;

  // Of all placements of the layer's paths.
  uint32_t Number(const Placement& placement) const {
    return numbers_[placement.block - given_.front().block] + placement.entry;
  }

  TravelTotals Estimate(size_t place, const Placement& from, const Placement& to) const {
    TravelTotals totals = writer_.EstimateTravel(place, from, to, travel_);
    if (totals.open_mm > longest_open_mm_ + kSlackMm) totals.too_long = 1;
    if (IsRefused(from, to)) ++totals.too_long;
    return totals;
  }

  const LayerWriter& writer_;
  const TravelModel& travel_;
  const MergeRules& rules_;
  const LayerOrder given_;
  std::vector<uint32_t> numbers_;            // [path] the number of its first placement
  std::vector<TravelTotals> given_travels_;  // [place] as the layer was given
  double longest_open_mm_ = 0;               // of them
  bool moved_ = false;
  absl::flat_hash_map<Key, TravelTotals> known_;
};

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

// Of what begins or ends elsewhere only the whole file tells whether it crosses too many walls, and
// only the travel to it whether it is too long.
MergeLimits AnyLength(MergeLimits limits) {
  limits.mm = std::numeric_limits<double>::infinity();
  return limits;
}

MergeLimits AnyCrossings(MergeLimits limits) {
  limits.crossings = std::numeric_limits<int64_t>::max();
  limits.crossing_seconds = std::max(limits.crossing_seconds, kSparingCrossingSeconds);
  return AnyLength(limits);
}

// One layer whose orders are merged.
class LayerMerge {
 public:
  using Effort = OrderPolisher::Effort;

  LayerMerge(const LayerWriter& writer, const TravelModel& travel,
             const std::vector<LayerOrder>& found, const MergeRules& rules)
      : rules_(rules),
        outlines_(writer.outlines()),
        given_(writer.GivenOrder()),
        found_(found),
        travels_(writer, travel, rules),
        were_(OrderMerger(estimate_, {}).TotalsOf(given_)),
        strict_(estimate_, LimitsOf(were_, rules)),
        few_(estimate_, AnyLength(LimitsOf(were_, rules))),
        quick_(estimate_, AnyCrossings(LimitsOf(were_, rules))) {
    all_ = found;
    all_.push_back(given_);
    travels_.MoveObjects();
    if (!rules.freedom) return;
    polisher_.emplace(given_.front().block, writer.outlines(), *rules.freedom, estimate_,
                      *rules.polish);
  }

  std::vector<LayerOrder> Merge() {
    std::vector<LayerOrder> begun = found_;
    if (IsFree(rules_.policy)) {
      for (const LayerOrder& order : found_) begun.push_back(InGivenOrder(order));
    }
    LayerOrder best_between = Better(strict_, given_, found_, Effort::kSettle);
    std::vector<LayerOrder> merged;
    for (const LayerOrder& order : begun) {
      merged.push_back(Better(quick_, order, all_, Effort::kSettle));
      if (!EndsAlike(order, given_)) {
        merged.push_back(Better(few_, order, all_, Effort::kKick));
        continue;
      }
      LayerOrder better = Better(strict_, order, all_, Effort::kSettle);
      if (Rank(better) < Rank(best_between)) best_between = std::move(better);
    }
    best_between = Better(strict_, best_between, {}, Effort::kKick);
    if (best_between != given_) merged.push_back(std::move(best_between));
    AddSparing(merged);
    if (!rules_.islands.empty()) AddRested(merged);
    return merged;
  }

  LayerOrder Settle(const LayerOrder& order) const {
    return Better(few_, order, {}, Effort::kSettle);
  }

  // `order` with no more retractions than the file's own; then with fewer at a price, which a
  // search that is at its limit of crossings may come to where it cannot come within the first.
  std::vector<LayerOrder> Spare(const LayerOrder& order) const {
    MergeLimits few = LimitsOf(were_, rules_);
    if (!EndsAlike(order, given_)) few = AnyLength(few);
    MergeLimits priced = EndsAlike(order, given_) ? few : AnyCrossings(few);
    few.retractions = were_.retractions;
    priced.retraction_seconds = kSparedRetractionSeconds;
    return {Better(OrderMerger(estimate_, few), order, {}, Effort::kKick),
            Better(OrderMerger(estimate_, priced), order, {}, Effort::kKick)};
  }

  // See RepairedOrder.
  std::optional<LayerOrder> Repair(LayerOrder order, const LayerFreedom& freedom, size_t reach) {
    size_t repairs = 0;
    for (size_t place = 1; place < order.size() && repairs < kMostRepairs; ++place) {
      if (!travels_.IsRefused(order[place - 1], order[place])) continue;
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
  // Kicks take long: only the orders that are the likeliest to be chosen are worth them.
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
  void AddSparing(std::vector<LayerOrder>& merged) const {
    const bool all_retract_more = std::all_of(merged.begin(), merged.end(), [&](const auto& order) {
      return strict_.TotalsOf(order).retractions > were_.retractions;
    });
    if (!all_retract_more || rules_.as_many_retractions) return;
    MergeLimits sparing = LimitsOf(were_, rules_);
    sparing.retractions = were_.retractions;
    LayerOrder order = Better(OrderMerger(estimate_, sparing), given_, found_, Effort::kKick);
    if (order != given_) merged.push_back(std::move(order));
  }

  // The best of `merged`, and the best of those that begin and end as the file does, with their
  // islands in other sequences; within these they may become better.
  void AddRested(std::vector<LayerOrder>& merged) const {
    if (merged.empty() || !rules_.freedom) return;
    const IslandParts parts{rules_.islands, rules_.freedom->group};
    LayerFreedom freedom = *rules_.freedom;
    freedom.group = IslandGroups(parts);
    const OrderPolisher polisher(given_.front().block, outlines_, freedom, estimate_,
                                 *rules_.polish);
    const auto quicker = [this](const LayerOrder& a, const LayerOrder& b) {
      return quick_.IsBetter(quick_.TotalsOf(a), quick_.TotalsOf(b));
    };
    std::vector<LayerOrder> bases = {*std::min_element(merged.begin(), merged.end(), quicker)};
    if (EndsAlike(merged.back(), given_)) bases.push_back(merged.back());
    for (const LayerOrder& base : bases) {
      for (const LayerOrder& order : IslandOrders(given_, base, parts)) {
        merged.push_back(polisher.Polish(order, quick_, Effort::kSettle));
      }
    }
  }

  const MergeRules& rules_;
  const std::vector<Outline>& outlines_;
  const LayerOrder given_;
  const std::vector<LayerOrder> found_;
  std::vector<LayerOrder> all_;  // of them and given
  KnownTravels travels_;
  const TravelEstimate estimate_ = std::ref(travels_);
  const TravelTotals were_;
  const OrderMerger strict_;  // keeps to what holds for the layer
  const OrderMerger few_;     // but for its length
  const OrderMerger quick_;   // and for its crossings
  std::optional<OrderPolisher> polisher_;
};

}  // namespace

std::vector<LayerOrder> MergedOrders(const LayerWriter& writer, const TravelModel& travel,
                                     const std::vector<LayerOrder>& found,
                                     const MergeRules& rules) {
  const LayerOrder given = writer.GivenOrder();
  for (const LayerOrder& order : found) {
    if (!IsWhole(order, given)) return found;
  }
  return LayerMerge(writer, travel, found, rules).Merge();
}

std::optional<LayerOrder> RepairedOrder(const LayerWriter& writer, const TravelModel& travel,
                                        const LayerOrder& order, const MergeRules& rules,
                                        const LayerFreedom& freedom, size_t reach) {
  if (!IsWhole(order, writer.GivenOrder())) return std::nullopt;
  return LayerMerge(writer, travel, {}, rules).Repair(order, freedom, reach);
}

LayerOrder SettledOrder(const LayerWriter& writer, const TravelModel& travel,
                        const LayerOrder& order, const MergeRules& rules) {
  if (!IsWhole(order, writer.GivenOrder())) return order;
  return LayerMerge(writer, travel, {}, rules).Settle(order);
}

std::vector<LayerOrder> SparingOrders(const LayerWriter& writer, const TravelModel& travel,
                                      const LayerOrder& order, const MergeRules& rules) {
  if (!IsWhole(order, writer.GivenOrder())) return {};
  return LayerMerge(writer, travel, {}, rules).Spare(order);
}

}  // namespace traverse::gcode
