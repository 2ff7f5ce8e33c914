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
#include "engine/schedule/budget_split.h"
#include "engine/schedule/layer_fingerprint.h"
#include "engine/schedule/route_history.h"
#include "engine/strategy/strategy.h"

namespace traverse {

// The best routes of layers whose true start is known, by problem key and by what comes next.
struct AnchoredRoutes {
  using ByKey = std::unordered_map<uint64_t, KnownRoutePtr>;
  ByKey alone;     // as in LayerAlone; only its stage uses it
  ByKey anchored;  // only anchor uses it
};

// A layer's part of the chain that is solved one layer after the other; of one whose route the
// caller knows, and which resumes it, of the caller's routes as they are.
struct LayerAlone {
  Solution solution;
  Point start;
  Point end = {};
  double cost = 0;
  KnownRoutePtr known = {};  // as in ChainLayer
};

// A layer's part of the chain that greedy would go.
struct GreedyLayer {
  Point start;
  Route route;
  Point end = {};  // cleaning included
  double cost = 0;
};

// A layer on its way. A stage owns its layer and works without the lock, but hands over under it.
struct ChainLayer {
  uint64_t index = 0;
  JobLayer given;  // as it was added
  CostSpec cost;   // of its searches (SymmetricCost)
  LayerSize size;
  bool looks_ahead = false;  // it may be ended with the next layer in view
  bool looked_at = false;    // the layer before is ended with this one in view

  // Set by prepare.
  Point predicted_start;
  LayerFingerprint fingerprint;
  Point origin;
  uint64_t key = 0;  // for the predicted start
  std::unique_ptr<const WallCost> walls;
  std::unique_ptr<const WallCost> linked_walls;  // of a layer with links: at their true cost
  std::optional<Point> finish;
  Route given_route;
  LayerOutcome outcome;  // the part about the given order

  // Set by prepare, if the clock may cut a search short.
  std::optional<GreedyLayer> greedy;

  // Set by prepare: whether searches begin with the route that the caller knows.
  bool resumes_initial = false;

  // Set by prepare: whether the layer is part of the chain that is solved one layer after the
  // other.
  bool carries_alone = false;

  // Set by prepare, if routes are reused: the route to start from (null if there is none), and this
  // layer's own route, for others. The lock guards their contents, which do not change once they
  // are ready.
  RouteHistory::Entry precursor;
  RouteHistory::Entry result;

  // Set by prepare: the known routes of the layers before this one, back to the last whose start
  // was certain.
  std::shared_ptr<AnchoredRoutes> anchored;

  // What share of the job's time the layer may use, once solving has begun, and what it has used.
  double weight = 0;
  Budget::Clock::duration allotted = Budget::Clock::duration::max();
  Budget::Clock::duration used = Budget::Clock::duration::zero();

  // Set when each stage begins: when its search must end, so that all of them keep within that
  // share, and greedy has its time. Unset: never.
  std::optional<Budget::Clock::time_point> search_end;

  // Set with it: when greedy must end, if it takes long.
  std::optional<Budget::Clock::time_point> greedy_end;

  // From the first stage that solves the layer to its anchor. One stage at a time uses it.
  std::unique_ptr<PreparedLayer> prepared;

  // Set by solve and second.
  Solution first;
  bool initial_holds = false;     // searching from the route that the caller knows gained nothing
  bool searched_in_vain = false;  // see PendingRoute
  BoundMultipliers bound_multipliers;
  std::optional<Point> second_start;
  Solution second;

  // Set by the stage of that name, which only layers that look or are looked at have.
  std::optional<LayerAlone> alone;

  // Set by the anchor of the layer before, if that looked ahead: a route from its end.
  Route foreseen;

  // Set with it, if this is the last layer in view: a route from where the layers before it are
  // foreseen to end, towards where it ends alone.
  Route way_back;

  // Set with it: the route from there by which the job is not longer than one layer after the
  // other. Empty: the one found alone.
  Route fallback;

  // Set by anchor, if routes are reused.
  KnownRoutePtr known;

  // Guarded by the lock.
  std::optional<Point> first_end;  // if solved: where the head is then, cleaning included
  bool solved = false;             // the layer's true start can be used
  bool solving_alone = false;      // alone has been submitted
  std::optional<Point> alone_end;  // if that is done: where the head is then, cleaning included
  bool anchoring = false;          // anchor has been submitted
  std::optional<Point> end;        // if anchored: where the head is then, cleaning included
  LinkSeconds departure;           // if anchored: from its last path to the next layer
  double over_alone = 0;           // if anchored: see TrueStart, after this layer
  double over_greedy = 0;          // the same
};
using ChainLayerPtr = std::shared_ptr<ChainLayer>;

// The layers behind one that ends with them in view, in build order.
using LayersInView = std::vector<ChainLayerPtr>;

// A layer's true start, and the layers for whose sake its end is chosen.
struct TrueStart {
  Point start;
  LayersInView view;

  // What it takes to leave the last path of the layer before.
  LinkSeconds departure = {};

  // Whether no known layer begins where the last of these ends.
  bool end_is_free = true;

  // What the layers before cost more than one after the other, since the last whose start did not
  // depend on a layer that looked ahead.
  double over_alone = 0;

  // What they cost more than greedy's chain, since the last whose start was certain.
  double over_greedy = 0;

  // Whether a layer may begin where this one ends, and that layer; null if it is not known yet.
  bool is_followed = false;
  std::shared_ptr<const ChainLayer> next = nullptr;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_CHAIN_LAYER_H_
