// Routes found earlier in the job, for layers of the same make to start from.

#ifndef TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_
#define TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/model/point.h"
#include "engine/model/route.h"
#include "engine/proof/bounds/lower_bound.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// A route of a layer and what is known of it. Immutable once it is shared.
struct KnownRoute {
  Solution solution;
  double cost = 0;

  // The very layer: layers that share all of these are the same problem.
  uint64_t place = 0;  // PlanPrint::place
  Point start;
  std::optional<Point> finish;

  BoundMultipliers multipliers;  // of the search for its lower bound
};
using KnownRoutePtr = std::shared_ptr<const KnownRoute>;

// What a layer will have added to what is known of its kind: layers of one make that begin and end
// at the same place, all told from their own origins. Guarded by whoever shares it between threads.
struct RouteToCome {
  uint64_t kind = 0;
  std::shared_ptr<RouteToCome> previous;  // of the same kind, as long as this one needs it
  std::shared_ptr<RouteToCome> next;

  // The layer's own part.
  KnownRoutePtr own;
  bool in_vain = false;  // it was searched from the best route known, and nothing was gained

  // Once the layer and all of its kind before it have given theirs: the best of their routes, and
  // how many searches since it was found were in vain.
  bool ready = false;
  KnownRoutePtr best;
  int idle = 0;

  std::vector<uint64_t> waiting;  // layers that start from it
};

// Extruded parts repeat their layers, as they are or moved along. A layer then starts from the best
// route that is known of its kind kLag repetitions before it, so that what is gained adds up along
// the job, while kLag layers of each kind can still be solved at the same time; the first of a kind
// starts from a route of its make. Which routes these are depends on the order of layers alone,
// never on timing.
class RouteHistory {
 public:
  using Entry = std::shared_ptr<RouteToCome>;

  // Enters a layer, later than those entered before, and sets `mine` up. Returns what to start
  // from; null for the first of its make.
  Entry Enter(uint64_t make, uint64_t kind, const Entry& mine);

  // A route of this kind was found in another way.
  void Learn(uint64_t make, uint64_t kind, KnownRoutePtr known);

  // Sets the layer's part. Returns the layers that waited for what is ready now.
  static std::vector<uint64_t> Complete(Entry entry, KnownRoutePtr own, bool in_vain);

  static constexpr size_t kLag = 4;

  // After so many searches in vain, layers of a kind are not searched again.
  static constexpr int kMostIdle = 3;

 private:
  // A job that never repeats a layer must not grow without bound.
  static constexpr size_t kMostMakes = 128;
  static constexpr size_t kMostKinds = 32;

  struct Make {
    std::deque<Entry> entries;  // the last kLag
    std::unordered_map<uint64_t, std::deque<Entry>> kinds;
  };
  Make& MakeOf(uint64_t make);
  static Entry Push(std::deque<Entry>& entries, const Entry& mine);

  std::unordered_map<uint64_t, Make> makes_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_
