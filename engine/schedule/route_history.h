// Routes found earlier in the job, for layers of the same make to start from.

#ifndef TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_
#define TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/model/point.h"
#include "engine/model/route.h"

namespace traverse {

// The route that a layer will have been given. Guarded by whoever shares it between threads.
struct RouteToCome {
  bool ready = false;
  Route route;  // if ready; empty if there is none to start from
  std::vector<double>
      bound_multipliers;  // of the search for its lower bound, as LowerBound has them
  // Where the head was before it, from the plan's origin, and how often in a row such a layer was
  // searched from there without a gain.
  Point start;
  int idle_repetitions = 0;

  // Valid where both the layer and the start are at the very same place.
  Point origin;
  std::optional<double> lower_bound;

  std::vector<uint64_t> waiting;  // layers that start from it
};

// Extruded parts repeat their layers, as they are or moved along. A layer then starts from the
// route of the one kLag repetitions before it, so that what is gained adds up along the job, while
// kLag layers of each make can still be solved at the same time. Which route that is depends on the
// order of layers alone, never on timing.
class RouteHistory {
 public:
  using Entry = std::shared_ptr<RouteToCome>;

  // Enters a layer of the make `fingerprint`, later than those entered before. Returns the route to
  // start from; null for the first of its make.
  Entry Enter(uint64_t fingerprint, Entry mine) {
    // A job that never repeats a layer must not grow without bound.
    if (makes_.size() >= kMostMakes && makes_.count(fingerprint) == 0) makes_.clear();
    std::deque<Entry>& make = makes_[fingerprint];
    Entry model = make.empty() ? nullptr : make.front();
    make.push_back(std::move(mine));
    if (make.size() > kLag) make.pop_front();
    return model;
  }

  static constexpr size_t kLag = 4;

  // After so many repetitions without a gain, a layer is not searched again from the same start.
  static constexpr int kMostIdle = 3;

 private:
  static constexpr size_t kMostMakes = 128;

  std::unordered_map<uint64_t, std::deque<Entry>> makes_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_
