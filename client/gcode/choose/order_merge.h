// The best of several orders of one layer, where none may be had whole, or none is the best
// everywhere.
//
//   begun with    a | c b d | e f        a run of paths, in the order and with the entries that
//   another one   b c a d f e            another one has them in: the whole layer first, then
//   tried         a | b c d | e f        halves, and so on down to single paths
//
// What makes the order better is kept, until nothing does. Orders of two paths on which all agree
// stay as they are; so do the first and the last path of the order that is begun with.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_MERGE_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_MERGE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "client/gcode/write/placed_path.h"
#include "client/gcode/write/way_totals.h"

namespace traverse::gcode {

// What an order may come to at most.
struct MergeLimits {
  double mm = std::numeric_limits<double>::infinity();
  int64_t crossings = std::numeric_limits<int64_t>::max();
  int64_t open = std::numeric_limits<int64_t>::max();
  int64_t retractions = std::numeric_limits<int64_t>::max();
  bool as_many_retractions = false;  // and no fewer

  double crossing_seconds = 0;  // that each crossing counts for
};

// Estimates the way to place `place` of the layer, from 1, where `to` follows `from`.
using WayEstimate =
    std::function<WayTotals(size_t place, const Placement& from, const Placement& to)>;

class OrderMerger {
 public:
  // `estimate` outlives the merger.
  OrderMerger(const WayEstimate& estimate, const MergeLimits& limits)
      : estimate_(estimate), limits_(limits) {}

  WayTotals TotalsOf(const LayerOrder& order) const;

  // By how much `totals` are more than may be; 0 if they are not.
  double Excess(const WayTotals& totals) const;

  // Estimated seconds, crossings counted.
  double Score(const WayTotals& totals) const;

  // `begun` made better by runs of `others`: first less beyond the limits, then quicker. All have
  // the same paths. Asks for at most kMostWays ways, or as many as there are paths if that is more.
  LayerOrder Merge(const LayerOrder& begun, const std::vector<LayerOrder>& others) const;

  static constexpr size_t kMostWays = 20'000;

 private:
  const WayEstimate& estimate_;
  const MergeLimits limits_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_MERGE_H_
