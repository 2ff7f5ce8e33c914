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

// A route of a layer with its bound. Immutable once it is shared.
struct KnownRoute {
  Solution solution;
  double cost = 0;

  // Identifies the layer exactly: layers that share all of these are the same problem.
  uint64_t exact = 0;  // LayerFingerprint::exact
  Point start;
  std::optional<Point> finish;

  BoundMultipliers multipliers;  // from the search for its lower bound
};
using KnownRoutePtr = std::shared_ptr<const KnownRoute>;

// What a layer will contribute to the routes of its key: layers of one shape that begin and end at
// the same points, relative to their own origins. Whoever shares it between threads guards it.
struct PendingRoute {
  ~PendingRoute();

  uint64_t key = 0;
  std::shared_ptr<PendingRoute> previous;  // of the same key, while this layer needs it
  std::weak_ptr<PendingRoute> next;        // null also if nobody needs it any more

  // The layer's own contribution.
  KnownRoutePtr own;
  bool in_vain = false;  // the layer was searched from the best known route without any gain

  // Set once this layer and all before it with the same key have contributed: the best of their
  // routes, and how many searches since it was found were in vain.
  bool ready = false;
  KnownRoutePtr best;
  int idle = 0;

  std::vector<uint64_t> waiting;  // layers that start from it
};

// Extruded parts repeat their layers, in place or shifted. A layer then starts from the best
// route that its key had kLag repetitions earlier. So gains add up along the job, while kLag
// layers of each key can be solved at the same time. The first layer of a key starts from a
// route of its shape. Which routes these are depends only on the order of layers, never on
// timing.
class RouteHistory {
 public:
  using Entry = std::shared_ptr<PendingRoute>;

  // Enters a layer that comes after those entered before, and sets `mine` up. Returns the entry to
  // start from; null for the first layer of its shape.
  Entry Enter(uint64_t shape, uint64_t key, const Entry& mine);

  // How many layers of the shape were entered, not counting those forgotten.
  int Seen(uint64_t shape) const;

  // Adds a route of this key that was found in another way.
  void Learn(uint64_t shape, uint64_t key, KnownRoutePtr known);

  // Sets the layer's contribution. Returns the layers that waited for what is now ready.
  static std::vector<uint64_t> Complete(Entry entry, KnownRoutePtr own, bool in_vain);

  static constexpr size_t kLag = 4;

  // After this many searches in vain, layers of a key are not searched again.
  static constexpr int kMostIdle = 3;

 private:
  // Bounds the memory of a job that never repeats a layer.
  static constexpr size_t kMostShapes = 128;
  static constexpr size_t kMostKeys = 32;

  struct Shape {
    int seen = 0;               // layers
    std::deque<Entry> entries;  // the last kLag
    std::unordered_map<uint64_t, std::deque<Entry>> keys;
  };
  Shape& OfShape(uint64_t shape);
  static Entry Push(std::deque<Entry>& entries, const Entry& mine);

  std::unordered_map<uint64_t, Shape> shapes_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_ROUTE_HISTORY_H_
