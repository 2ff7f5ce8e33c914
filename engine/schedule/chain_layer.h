// One layer on its way through the chain.

#ifndef TRAVERSE_ENGINE_SCHEDULE_CHAIN_LAYER_H_
#define TRAVERSE_ENGINE_SCHEDULE_CHAIN_LAYER_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/base/budget.h"
#include "engine/cost/wall_cost.h"
#include "engine/engine.h"
#include "engine/proof/bounds/lower_bound.h"
#include "engine/schedule/layer_fingerprint.h"
#include "engine/schedule/route_history.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// The best routes of anchored layers, by problem key and by what comes next.
using AnchoredRoutes = std::unordered_map<uint64_t, KnownRoutePtr>;

// A layer on its way. A stage owns its layer and works without the lock, but hands over under it.
struct ChainLayer {
  uint64_t index = 0;
  JobLayer given;  // as it was added
  CostSpec cost;
  int64_t points = 0;

  // Set by prepare.
  Point predicted_start;
  LayerFingerprint fingerprint;
  Point origin;
  uint64_t key = 0;  // for the predicted start
  std::unique_ptr<const WallCost> walls;
  std::optional<Point> finish;
  Route given_route;
  LayerOutcome outcome;  // the part about the given order

  // Set by prepare, if routes are reused: the route to start from (null if there is none), and this
  // layer's own route, for others. The lock guards their contents, which do not change once they
  // are ready.
  RouteHistory::Entry precursor;
  RouteHistory::Entry result;

  // Set by prepare: the known routes of the layers before this one, back to the last whose start
  // was certain. Only anchor uses the contents.
  std::shared_ptr<AnchoredRoutes> anchored;

  // What share of the job's time the layer may use, once solving has begun.
  double weight = 0;
  Budget::Clock::duration allotted = Budget::Clock::duration::max();

  // From the first stage that solves the layer to its anchor. One stage at a time uses it.
  std::unique_ptr<PreparedLayer> prepared;

  // Set by solve and second.
  Solution first;
  bool searched_in_vain = false;  // see PendingRoute
  BoundMultipliers bound_multipliers;
  std::optional<Point> second_start;
  Solution second;

  // Set by the anchor of the layer before, if that looked ahead: a route from its end.
  Route foreseen;

  // Set by anchor, if routes are reused.
  KnownRoutePtr known;

  // Guarded by the lock.
  std::optional<Point> first_end;  // if solved: where the head is then, cleaning included
  bool solved = false;             // the layer can be anchored
  bool anchoring = false;          // anchor has been submitted
  std::optional<Point> end;        // if anchored: where the head is then, cleaning included
};
using ChainLayerPtr = std::shared_ptr<ChainLayer>;

// The layers behind one that ends with them in view, in build order.
using LayersInView = std::vector<ChainLayerPtr>;

// A layer's true start, and the layers for whose sake its end is chosen.
struct TrueStart {
  Point start;
  LayersInView view;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_CHAIN_LAYER_H_
