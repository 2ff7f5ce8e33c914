// Combines several orders of one layer, if none is allowed as a whole or none is the best
// everywhere.
//
//   begun with    a | c b d | e f        a run of paths, in the order and with the entries that
//   another one   b c a d f e            another one has them in: the whole layer first, then
//   tried         a | b c d | e f        halves, and so on down to single paths
//
// Keeps what makes the order better, until nothing does. Pairs of paths on whose order all agree
// stay in that order; so do the first and the last path of the order that is begun with.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_MERGE_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_MERGE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "client/gcode/link/travel_totals.h"
#include "client/gcode/model/placed_path.h"

namespace traverse::gcode {

// The most that an order may amount to, and the fewest retractions.
struct MergeLimits {
  int64_t crossings = std::numeric_limits<int64_t>::max();
  int64_t open = std::numeric_limits<int64_t>::max();
  int64_t retractions = std::numeric_limits<int64_t>::max();
  int64_t least_retractions = 0;

  double crossing_seconds = 0;    // the cost of each crossing
  double retraction_seconds = 0;  // and of each retraction beside its time
};

// Estimates the travel to position `place` of the layer, from 1, where `to` follows `from`.
using TravelEstimate =
    std::function<TravelTotals(size_t place, const Placement& from, const Placement& to)>;

class OrderMerger {
 public:
  // `estimate` must outlive the merger.
  OrderMerger(const TravelEstimate& estimate, const MergeLimits& limits)
      : estimate_(estimate), limits_(limits) {}

  TravelTotals TotalsOf(const LayerOrder& order) const;

  // By how much `totals` exceed the limits; 0 if they do not.
  double Excess(const TravelTotals& totals) const;

  // Estimated seconds, including the cost of crossings.
  double Score(const TravelTotals& totals) const;

  // True if `totals` exceed the limits by less than `others` do, or by the same and score lower.
  bool IsBetter(const TravelTotals& totals, const TravelTotals& others) const;

  // `begun`, improved by runs of `others`: first less beyond the limits, then faster. All have the
  // same paths. Asks for at most kMostTravels estimates, or one per path if that is more.
  LayerOrder Merge(const LayerOrder& begun, const std::vector<LayerOrder>& others) const;

  static constexpr size_t kMostTravels = 20'000;

 private:
  const TravelEstimate& estimate_;
  const MergeLimits limits_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_MERGE_H_
