#include "client/gcode/choose/merged_orders.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <utility>

#include "absl/container/flat_hash_map.h"

namespace traverse::gcode {
namespace {

// What a crossing counts where an order may have more of them than the file: some layers are to
// have fewer, so that others may have more.
constexpr double kSparingCrossingSeconds = 0.25;

// Rounding of sums of lengths.
constexpr double kSlackMm = 1e-6;

MergeLimits LimitsOf(const WayTotals& given, const MergeRules& rules) {
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

// The ways of a layer. Those around walls take long to find, and the same few are asked for again
// and again.
class KnownWays {
 public:
  KnownWays(const LayerWriter& writer, const TravelModel& travel, const MergeRules& rules)
      : writer_(writer), travel_(travel), rules_(rules) {
    const LayerOrder given = writer.GivenOrder();
    for (size_t i = 1; i < given.size(); ++i) {
      const WayTotals way = writer.EstimateWay(i, given[i - 1], given[i], travel);
      if (way.open > 0) longest_open_mm_ = std::max(longest_open_mm_, way.mm);
    }
  }

  WayTotals operator()(size_t place, const Placement& from, const Placement& to) {
    const std::array<size_t, 5> key = {from.block, from.entry, to.block, to.entry,
                                       rules_.boundaries[place] ? place : 0};
    const auto [found, added] = known_.try_emplace(key);
    if (!added) return found->second;
    WayTotals way = writer_.EstimateWay(place, from, to, travel_);
    if (way.open > 0 && way.mm > longest_open_mm_ + kSlackMm) way.too_long = 1;
    return found->second = way;
  }

 private:
  const LayerWriter& writer_;
  const TravelModel& travel_;
  const MergeRules& rules_;
  double longest_open_mm_ = 0;  // as the layer was given
  absl::flat_hash_map<std::array<size_t, 5>, WayTotals> known_;
};

bool EndsAlike(const LayerOrder& a, const LayerOrder& b) {
  return a.front() == b.front() && a.back() == b.back();
}

// The paths in the order of the file, begun as in `order`: where walls may change places, ways that
// are as long may have to be retracted that were open.
LayerOrder InGivenOrder(LayerOrder order) {
  std::sort(order.begin(), order.end(),
            [](const Placement& a, const Placement& b) { return a.block < b.block; });
  return order;
}

}  // namespace

std::vector<LayerOrder> MergedOrders(const LayerWriter& writer, const TravelModel& travel,
                                     const std::vector<LayerOrder>& found,
                                     const MergeRules& rules) {
  const LayerOrder given = writer.GivenOrder();
  for (const LayerOrder& order : found) {
    if (!IsWhole(order, given)) return found;
  }
  KnownWays ways(writer, travel, rules);
  const WayEstimate estimate = std::ref(ways);
  const WayTotals were = OrderMerger(estimate, {}).TotalsOf(given);
  MergeLimits limits = LimitsOf(were, rules);
  const OrderMerger strict(estimate, limits);
  const auto rank = [&strict](const LayerOrder& order) {
    const WayTotals totals = strict.TotalsOf(order);
    return std::pair(strict.Excess(totals), strict.Score(totals));
  };
  // Of what begins or ends elsewhere only the whole file tells whether it crosses too many walls,
  // and only the way to it whether it is too long.
  limits.mm = std::numeric_limits<double>::infinity();
  const OrderMerger few(estimate, limits);
  limits.crossings = std::numeric_limits<int64_t>::max();
  limits.crossing_seconds = std::max(limits.crossing_seconds, kSparingCrossingSeconds);
  const OrderMerger quick(estimate, limits);
  std::vector<LayerOrder> all = found;
  all.push_back(given);
  std::vector<LayerOrder> merged;
  LayerOrder best_between = strict.Merge(given, found);
  std::vector<LayerOrder> begun = found;
  if (rules.policy == Policy::kFree) {
    for (const LayerOrder& order : found) begun.push_back(InGivenOrder(order));
  }
  for (const LayerOrder& order : begun) {
    if (!EndsAlike(order, given)) {
      merged.push_back(quick.Merge(order, all));
      merged.push_back(few.Merge(order, all));
      continue;
    }
    LayerOrder better = strict.Merge(order, all);
    if (rank(better) < rank(best_between)) best_between = std::move(better);
    merged.push_back(quick.Merge(order, all));
  }
  if (best_between != given) merged.push_back(std::move(best_between));
  // The file may have no retractions to spare.
  const bool all_retract_more = std::all_of(merged.begin(), merged.end(), [&](const auto& order) {
    return strict.TotalsOf(order).retractions > were.retractions;
  });
  if (all_retract_more && !rules.as_many_retractions) {
    MergeLimits sparing = LimitsOf(were, rules);
    sparing.retractions = were.retractions;
    LayerOrder order = OrderMerger(estimate, sparing).Merge(given, found);
    if (order != given) merged.push_back(std::move(order));
  }
  return merged;
}

}  // namespace traverse::gcode
