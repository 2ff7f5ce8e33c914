// Orders of a layer that begin and end at other islands.
//
// Whether islands rest long enough (island_rests.h) depends on where a layer begins, and in which
// direction it goes round, and hardly on the paths within an island. So an order is turned: it
// begins at another island and goes round, which costs no more than the way from its end to its
// begin, less the travel where it now begins. Where islands rest for a part of a layer's time only,
// it is enough that the first ones come in another sequence.
//
//   as found                a b c d e f
//   turned                  c d e f a b   begun at c; and so at each island, or at a few of them
//   the other way round     f e d c b a   and its turns
//   with another head       c b a d e f   and the other sequences of the first ones
//
// An order that comes back to islands is also tried with each island's paths together, and with the
// islands in the sequence of the file. Where islands near each other count as one, so are these.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ISLAND_TURNS_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ISLAND_TURNS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "client/gcode/choose/orders/order_merge.h"
#include "client/gcode/model/placed_path.h"
#include "client/gcode/plan/layer_freedom.h"

namespace traverse::gcode {

// How long the paths of a layer take, and the travel between them: nominal_time.h.
struct LayerClock {
  std::vector<double> path_seconds;  // [path]
  double travel_mm_s = 150;
  double retraction_seconds = 0;

  double TravelSeconds(double mm, int64_t retractions) const {
    return mm / travel_mm_s + retraction_seconds * static_cast<double>(retractions);
  }
};

// The orders of one layer.
class IslandTurns {
 public:
  IslandTurns() = default;

  // The turns of `found`, orders with the same paths as `given`, which ascend: those within the
  // limits of `judge`, and of each kind no more than kMostOfAKind, the best ones. `islands`: [path]
  // the one that it lies in; once or, what counts as one first, twice. `rest_seconds`: for so long
  // islands rest at the most. `settle`, if set, makes an order better within its units before it is
  // turned. O(n log n) in the paths of each.
  using Settle =
      std::function<LayerOrder(const LayerOrder& order, const std::vector<uint32_t>& units)>;
  IslandTurns(const LayerOrder& given, const std::vector<LayerOrder>& found,
              const std::vector<std::vector<uint32_t>>& islands, double rest_seconds,
              const LayerFreedom& freedom, const TravelEstimate& estimate, const OrderMerger& judge,
              LayerClock clock, const Settle& settle = {});

  static constexpr size_t kMostOfAKind = 48;

  size_t size() const { return turns_.size(); }
  const TravelTotals& TotalsOf(size_t turn) const { return turns_[turn].totals; }
  LayerOrder OrderOf(size_t turn) const;

  // When each path of OrderOf(turn) begins and ends, two values a path, in seconds from the begin
  // of the first one.
  std::vector<double> MomentsOf(size_t turn) const;

  const LayerClock& clock() const { return clock_; }

  // [path] what has to stay together, so that the layer keeps the sequence of its islands.
  std::vector<uint32_t> UnitsOf(size_t turn) const;

 private:
  // An order, and the travel to each place.
  struct Base {
    LayerOrder order;
    std::vector<float> link_seconds;  // [place]
    std::vector<bool> begins;         // [place] a unit: what belongs together is not cut there
  };

  // Places [begin, end) of a base.
  struct Stretch {
    uint32_t begin = 0;
    uint32_t end = 0;
    float link_seconds = 0;  // of the link to it, as it is now
  };

  // A base as stretches of it, some of which, which adjoin, are in another sequence.
  struct Turn {
    uint32_t base = 0;
    bool head = false;  // the first ones alone are in another sequence
    std::vector<Stretch> stretches = {};
    TravelTotals totals;
  };

  class Maker;

  // Of the turns from `first` on.
  void KeepBest(const OrderMerger& judge, size_t first);

  LayerClock clock_;
  uint32_t first_block_ = 0;
  std::vector<Base> bases_;
  std::vector<Turn> turns_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ORDERS_ISLAND_TURNS_H_
