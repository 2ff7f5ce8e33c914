// Routes found earlier in the job, for layers of the same shape to start from.

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
  uint64_t exact = 0;  // LayerFingerprint::exact
  Point start;
  std::optional<Point> finish;

  BoundMultipliers multipliers;  // of the search for its lower bound
};
using KnownRoutePtr = std::shared_ptr<const KnownRoute>;

// What a layer will have added to what is known of its key: layers of one shape that begin and end
// at the same place, all told from their own origins. Guarded by whoever shares it between threads.
struct PendingRoute {
  ~PendingRoute();

  uint64_t key = 0;
  std::shared_ptr<PendingRoute> previous;  // of the same key, as long as this one needs it
  std::weak_ptr<PendingRoute> next;        // null, too, if nobody needs it any more

  // The layer's own part.
  KnownRoutePtr own;
  bool in_vain = false;  // it was searched from the best route known, and nothing was gained

  // Once the layer and all of its key before it have given theirs: the best of their routes, and
  // how many searches since it was found were in vain.
  bool ready = false;
  KnownRoutePtr best;
  int idle = 0;

  std::vector<uint64_t> waiting;  // layers that start from it
};

// Extruded parts repeat their layers, as they are or moved along. A layer then starts from the best
// route that is known of its key kLag repetitions before it, so that what is gained adds up along
// the job, while kLag layers of each key can still be solved at the same time; the first of a key
// starts from a route of its shape. Which routes these are depends on the order of layers alone,
// never on timing.
class RouteHistory {
 public:
  using Entry = std::shared_ptr<PendingRoute>;

  // Enters a layer, later than those entered before, and sets `mine` up. Returns what to start
  // from; null for the first of its shape.
  Entry Enter(uint64_t shape, uint64_t key, const Entry& mine);

  // A route of this key was found in another way.
  void Learn(uint64_t shape, uint64_t key, KnownRoutePtr known);

  // Sets the layer's part. Returns the layers that waited for what is ready now.
  static std::vector<uint64_t> Complete(Entry entry, KnownRoutePtr own, bool in_vain);

  static constexpr size_t kLag = 4;

  // After so many searches in vain, layers of a key are not searched again.
  static constexpr int kMostIdle = 3;

 private:
  // A job that never repeats a layer must not grow without bound.
  static constexpr size_t kMostShapes = 128;
  static constexpr size_t kMostKeys = 32;

  struct Shape {
    std::deque<Entry> entries;  // the last kLag
    std::unordered_map<uint64_t, std::deque<Entry>> keys;
  };
  Shape& OfShape(uint64_t shape);
  static Entry Push(std::deque<Entry>& entries, const Entry& mine);

  std::unordered_map<uint64_t, Shape> shapes_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_
