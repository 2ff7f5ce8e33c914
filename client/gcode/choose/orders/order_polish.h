// Improves an order of a layer by small changes (order_state.h), judged by the cost of its travel
// moves as written.
//
// The service's search knows a move by its two ends and assumes the same cost in both directions.
// The written move differs: after a wipe it starts where the wipe ends, the path before it pays for
// a retraction, and limits of the file forbid what the search only prices. Where the two differ,
// there are faster orders close to the one that the search found.
//
// Local search with kicks (Martin, Otto and Felten 1991): two short runs change places at any cost,
// then the search improves what lies around them, and undoes all of it if the order has not become
// better.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_POLISH_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_POLISH_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/gcode/choose/orders/order_merge.h"
#include "client/gcode/choose/orders/order_state.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/work_limit.h"

namespace traverse::gcode {

// How long orders may be improved; shared by several threads.
struct PolishLimit {
  WorkLimit work = {};

  // It is given up where estimates of travel moves gain less than this each, on the average.
  double seconds_per_travel = kSecondsPerTravel;

  // An estimate takes about twice as long; but gains come late and in steps, and a while without a
  // large one is often followed by one with it.
  static constexpr double kSecondsPerTravel = 1.5e-7;

  // One of a travel move that leads around walls.
  static constexpr double kSecondsPerDetour = 1e-6;
};

class OrderPolisher {
 public:
  enum class Effort : uint8_t {
    kSettle,  // until no change is an improvement
    kKick,    // then also with kicks
  };

  // For the layer with the paths `outlines`, from block `first_block` on. All outlive the polisher.
  OrderPolisher(uint32_t first_block, const std::vector<Outline>& outlines,
                const LayerFreedom& freedom, const TravelEstimate& estimate,
                const PolishLimit& limit);

  // `begun`, improved as OrderMerger::Merge does: first less beyond the limits of `judge`,
  // then faster. Its first and last paths stay. It makes no change beyond the layer's
  // freedom, but does not repair a `begun` that is beyond it. It stops when estimates gain too
  // little, when it has asked for about kMostTravelsEach of them per path, or at the limit.
  // REQUIRES: `begun` has each path of the layer once, or none.
  LayerOrder Polish(const LayerOrder& begun, const OrderMerger& judge, Effort effort) const {
    return PolishWithin(freedom_.group, begun, judge, effort);
  }

  // The same where no path leaves its group of `groups`, [path], instead of that of the layer's
  // freedom. REQUIRES: those of a group stand together in `begun`.
  LayerOrder PolishWithin(const std::vector<uint32_t>& groups, const LayerOrder& begun,
                          const OrderMerger& judge, Effort effort) const;

  static constexpr size_t kMostTravelsEach = 50'000;

 private:
  class Search;

  void FindNeighbors();
  uint32_t NearestEntry(uint32_t path, Point point) const;

  const uint32_t first_block_;
  const std::vector<Outline>& outlines_;
  const LayerFreedom& freedom_;
  const TravelEstimate& estimate_;
  const PolishLimit& limit_;
  std::vector<std::vector<uint32_t>> neighbors_;  // [path] nearest ones first
  const PathPairs pairs_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ORDER_POLISH_H_
