// An order of a layer made better by small changes (order_state.h), judged by what its ways come to
// when they are written.
//
// The search of the service knows a way by its two ends, and takes it to cost the same in either
// direction. What is written is not so: behind a wipe the way begins where that ends, the path that
// is left pays for a retraction, and what may not be more than in the file is not priced but
// forbidden. Where the two differ there are quicker orders than the one found, and near to it.
//
// Local search with kicks (Martin, Otto and Felten 1991): two short runs change places whatever it
// costs, what lies around is made better again, and if it is not better than before all of that is
// taken back.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_POLISH_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_POLISH_H_

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "client/gcode/choose/order_merge.h"
#include "client/gcode/choose/order_state.h"
#include "client/gcode/model/outline.h"
#include "client/gcode/plan/layer_freedom.h"
#include "client/gcode/write/placed_path.h"

namespace traverse::gcode {

// How long orders may be made better; from several threads.
struct PolishLimit {
  absl::Time until = absl::InfiniteFuture();
  std::stop_token cancel = {};

  bool Over() const {
    return cancel.stop_requested() || (until != absl::InfiniteFuture() && absl::Now() >= until);
  }
};

class OrderPolisher {
 public:
  enum class Effort : uint8_t {
    kSettle,  // until no change makes it better
    kKick,    // and then with kicks
  };

  // Of the layer with the paths `outlines`, from block `first_block` on. All outlive the polisher.
  OrderPolisher(uint32_t first_block, const std::vector<Outline>& outlines,
                const LayerFreedom& freedom, const WayEstimate& estimate, const PolishLimit& limit);

  // `begun` made better as OrderMerger::Merge does: first less beyond the limits of `judge`, then
  // quicker. Its first and its last path stay. Nothing is done that the layer's freedom does not
  // include; where `begun` is beyond that, it may stay so. It ends where a second of computing
  // saves less than a second of printing, and asks for hardly more than kMostWaysEach ways a path;
  // or at the limit.
  // REQUIRES: `begun` has each path of the layer once, or none.
  LayerOrder Polish(const LayerOrder& begun, const OrderMerger& judge, Effort effort) const;

  static constexpr size_t kMostWaysEach = 5000;

 private:
  class Search;

  void FindNeighbors();
  Vertex Begin(const Placement& placement) const;
  Vertex End(const Placement& placement) const;
  uint32_t NearestEntry(uint32_t path, Vertex point) const;

  const uint32_t first_block_;
  const std::vector<Outline>& outlines_;
  const LayerFreedom& freedom_;
  const WayEstimate& estimate_;
  const PolishLimit& limit_;
  std::vector<std::vector<uint32_t>> neighbors_;  // [path] nearest ones first
  const PathPairs pairs_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDER_POLISH_H_
