// Proves routes optimal: multipliers and memory of walks, made better until no cheaper route can be
// left.
//
// The lowest walk (walk_dp.h) bounds every route. Where it visits a cluster twice, that cluster's
// multiplier grows, where it leaves one out, it shrinks (deflected subgradient steps: Polyak 1969;
// Camerini, Fratta and Maffioli 1975). When that gains little, clusters between two visits of one
// cluster are made to remember it (dynamic ng-routes: Roberti and Mingozzi 2014). Whenever the gap
// has become smaller, what cannot be part of a better route is dropped for good, so passes get
// cheaper as the bound gets better. It ends when a lowest walk is a route, or costs as much as the
// best route.

#ifndef TRAVERSE_ENGINE_EXACT_WALK_BOUND_H_
#define TRAVERSE_ENGINE_EXACT_WALK_BOUND_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/exact/stage_model.h"

namespace traverse {

struct WalkBoundOptions {
  int first_memory = 5;          // clusters that each remembers at first, itself included
  double most_operations = 4e9;  // of one pass; memory grows with it
  int most_passes = 100000;
};

struct WalkBoundResult {
  std::vector<ClusterState> walk;  // the best route: the one given, or a better one
  double cost = 0;                 // of it
  double lower_bound = 0;          // of any route
  bool proven = false;             // lower_bound is cost, up to a relative 1e-9
  int passes = 0;
};

// Starts from `walk`, a route. REQUIRES: the model has a cluster, and no stage has more than
// kMostClusters. Deterministic unless the budget ends it.
inline constexpr int kMostClusters = 512;
WalkBoundResult BoundByWalks(const StageModel& model, const std::vector<ClusterState>& walk,
                             const WalkBoundOptions& options, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_EXACT_WALK_BOUND_H_
