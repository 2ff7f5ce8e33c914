// A lower bound of all layers of a job together.
//
// A layer's own bound holds for its start, which is where the route of the layer before happens to
// end. So the sum of these bounds is no bound of the job: ending that layer elsewhere may save more
// behind it than it costs. Layers that are done one right after the other are one plan
// (layers_in_order.h), and a bound of that plan is one of all their routes together. Where a layer
// begins at a given point or at the cleaning point, the chain is cut in two that do not depend on
// each other.

#ifndef TRAVERSE_ENGINE_SCHEDULE_CHAIN_BOUND_H_
#define TRAVERSE_ENGINE_SCHEDULE_CHAIN_BOUND_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>

#include "engine/base/budget.h"
#include "engine/model/cost_spec.h"
#include "engine/model/layer_problem.h"
#include "engine/model/plan.h"
#include "engine/model/route.h"

namespace traverse {

// A layer and the route found for it.
struct BoundedLayer {
  Plan plan;
  Route route;
  Point start;
  bool starts_where_last_ended = false;
  std::optional<Point> finish;  // the cleaning point, if the head goes there
  CostSpec cost;
};

// Which plans of a job are kept until its last layer is done. Not thread-safe.
class KeptPlans {
 public:
  // Jobs of more points than this have no bound of their chain, and none of their plans is kept.
  static constexpr size_t kMostPoints = 100'000;

  // Counts one more plan of the job. Returns whether all plans so far are kept.
  bool Add(const Plan& plan) {
    for (const Path& path : plan.paths) points_ += path.points.size();
    return points_ <= kMostPoints;
  }

  // Of all plans so far.
  size_t points() const { return points_; }

 private:
  size_t points_ = 0;
};

// Keeps the layers of a job until all are there. Not thread-safe.
class ChainBound {
 public:
  // A bound of the problem's routes. `known` is one of them.
  using BoundOf =
      std::function<std::optional<double>(const LayerProblem&, const Route& known, Budget&)>;

  // Layers may come in any order.
  void Add(uint64_t index, BoundedLayer layer);

  // Of the layers kept.
  int64_t points() const { return layers_.empty() ? 0 : static_cast<int64_t>(plans_.points()); }

  // No routes of all layers cost less together. Walls are left out, as they only add to costs. A
  // move to the cleaning point counts as in LayerOutcome::lower_bound. Unset if a part of the chain
  // has no bound, or its layers have different costs, or if there are too many points. Each part of
  // the chain may use its share of the budget by paths.
  std::optional<double> Compute(uint64_t seed, const BoundOf& bound_of, Budget& budget) const;

 private:
  using Iterator = std::map<uint64_t, BoundedLayer>::const_iterator;
  static std::optional<double> BoundOfPart(Iterator begin, Iterator end, uint64_t seed,
                                           const BoundOf& bound_of, Budget& budget);

  std::map<uint64_t, BoundedLayer> layers_;
  KeptPlans plans_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_CHAIN_BOUND_H_
