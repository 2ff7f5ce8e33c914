// One layer on its way through the chain.

#ifndef TRAVERSE_ENGINE_SCHEDULE_CHAIN_LAYER_H_
#define TRAVERSE_ENGINE_SCHEDULE_CHAIN_LAYER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>

#include "engine/base/budget.h"
#include "engine/cost/wall_cost.h"
#include "engine/engine.h"
#include "engine/proof/bounds/lower_bound.h"
#include "engine/schedule/layer_fingerprint.h"
#include "engine/schedule/route_history.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// The best routes of layers that were anchored, by problem key and what comes next.
using AnchoredRoutes = std::unordered_map<uint64_t, KnownRoutePtr>;

// One layer on its way. A stage owns its layer and works without the lock; hand-over is under it.
struct ChainLayer {
  uint64_t index = 0;
  JobLayer given;  // as it was added
  CostSpec cost;
  int64_t points = 0;

  // Set by prepare.
  Point predicted_start;
  LayerFingerprint fingerprint;
  Point origin;
  uint64_t key = 0;  // with the predicted start
  std::unique_ptr<const WallCost> walls;
  std::optional<Point> finish;
  Route given_route;
  LayerOutcome outcome;  // what concerns the given order

  // Set by prepare, where routes are used again: the route to start from, null if there is
  // none, and this layer's own, for others. What they hold is guarded by the lock; it does not
  // change once it is ready.
  RouteHistory::Entry precursor;
  RouteHistory::Entry result;

  // Set by prepare: what is known of the layers before this one back to the last whose start was
  // certain. Only anchor touches what it holds.
  std::shared_ptr<AnchoredRoutes> anchored;

  // What the layer may use of the job's time, once it has begun to be solved.
  double weight = 0;
  Budget::Clock::duration allotted = Budget::Clock::duration::max();

  // From the first stage that solves the layer to its anchor; one stage at a time uses it.
  std::unique_ptr<PreparedLayer> prepared;

  // Set by solve and second.
  Solution first;
  bool searched_in_vain = false;  // PendingRoute
  BoundMultipliers bound_multipliers;
  std::optional<Point> second_start;
  Solution second;

  // Set by the anchor of the layer before, where that looked ahead: a route from its end.
  Route foreseen;

  // Set by anchor, where routes are used again.
  KnownRoutePtr known;

  // Guarded by the lock.
  std::optional<Point> first_end;  // solved: where the head is then, a cleaning included
  bool solved = false;             // the layer itself is ready to be anchored
  bool anchoring = false;          // anchor is submitted
  std::optional<Point> end;        // anchored: where the head is then, a cleaning included
};
using ChainLayerPtr = std::shared_ptr<ChainLayer>;

// A layer's true start, and the next layer, if the end is chosen with a view to that.
struct TrueStart {
  Point start;
  ChainLayerPtr next;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_CHAIN_LAYER_H_
