// Improves the order that a search found for a layer, before it is written.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_MERGED_ORDERS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_MERGED_ORDERS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "client/gcode/choose/orders/known_travels.h"
#include "client/gcode/choose/orders/order_merge.h"
#include "client/gcode/choose/orders/order_polish.h"
#include "client/gcode/choose/orders/order_repair.h"
#include "client/gcode/choose/rows/rested_row.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/plan/policy.h"
#include "client/gcode/plan/travel_model.h"

namespace traverse::gcode {

// Rules for an order besides the file's own.
struct MergeRules {
  Policy policy = Policy::kSafe;
  Crossings crossings = Crossings::kKeep;
  bool as_many_retractions = false;  // each pushes a little more or less than it pulls

  // What may change in the layer, and for how long small changes improve its orders too
  // (order_polish.h): they do not unless both are set.
  std::optional<LayerFreedom> freedom = {};
  std::optional<PolishLimit> polish = {};

  // Pairs of paths that the verifier refused the other way round; beyond those of `freedom`, which
  // has them too.
  std::vector<PathPair> ordered = {};

  // Links that the verifier refused; the file's own count as allowed all the same. May be null.
  const LinkSet* refused = nullptr;
};

// Improves orders of one layer. Orders that have not each of its paths once stay as they are.
class LayerMerge {
 public:
  using Effort = OrderPolisher::Effort;

  // Both outlive it.
  LayerMerge(KnownTravels& travels, const MergeRules& rules);
  LayerMerge(const LayerMerge&) = delete;
  LayerMerge& operator=(const LayerMerge&) = delete;

  // `found`, improved with runs of the file's own order, and brought within the limits of the rules
  // as far as estimates tell (order_merge.h): in a few ways, of which only the best stays where it
  // begins and ends with the same paths as the file. Where IsFree(policy) it is also tried with its
  // paths in the order of the file.
  std::vector<LayerOrder> Merge(const LayerOrder& found) const;

  // `order`, one that was merged or in which whole objects have changed places, improved by small
  // changes; with kicks (order_polish.h) that takes long. Its first and last path stay. REQUIRES:
  // rules.freedom, rules.polish; and so do the next two.
  LayerOrder Improve(const LayerOrder& order, Effort effort);

  // `order`, one that was merged, improved with kicks in two ways so that it retracts less.
  std::vector<LayerOrder> Spare(const LayerOrder& order);

  // `order`, improved within `units`: [path] what has to stay together.
  LayerOrder SettleWithin(const LayerOrder& order, const std::vector<uint32_t>& units) const;

  // `order` with the pairs of the rules as sliced and without the links that they refuse, or as few
  // of them as can be had by changes around each. With greater `reach`, more paths around each are
  // as sliced at the most. Unset if all of them stay. REQUIRES: rules.freedom.
  std::optional<LayerOrder> Repair(LayerOrder order, size_t reach);

  // The turns of `orders` that may be chosen where islands must rest. `islands` as IslandTurns
  // takes them; for `rest_seconds` they rest at the most; `moments`: when each path begins and ends
  // in the file's own order. Of the result `given_times` and the travel to the layer are left to be
  // set. REQUIRES: rules.freedom.
  TurnedLayer Turn(std::vector<LayerOrder> orders, const TravelModel& travel,
                   const std::vector<std::vector<uint32_t>>& islands, double rest_seconds,
                   const std::vector<double>& moments) const;

 private:
  bool IsWhole(const LayerOrder& order) const;
  bool KeepsTogether(const LayerOrder& order) const;
  void StandAs(const LayerOrder& order);
  bool IsRefused(const Placement& from, const Placement& to) const;
  TravelTotals TravelTo(size_t place, const Placement& from, const Placement& to) const;
  LayerClock ClockOf(const std::vector<double>& moments, double mm_s) const;
  LayerOrder Better(const OrderMerger& judge, const LayerOrder& order,
                    const std::vector<LayerOrder>& others, Effort effort) const;
  std::pair<double, double> Rank(const LayerOrder& order) const;
  void AddSparing(const LayerOrder& found, std::vector<LayerOrder>& merged) const;

  const Outline& OutlineOf(const Placement& placement) const {
    return writer_.outlines()[placement.block - given_.front().block];
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

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_MERGED_ORDERS_H_
