// What a strategy is asked: one layer, its start and what moves cost.

#ifndef TRAVERSE_ENGINE_MODEL_LAYER_PROBLEM_H_
#define TRAVERSE_ENGINE_MODEL_LAYER_PROBLEM_H_

#include <cstdint>
#include <optional>

#include "engine/model/cost_spec.h"
#include "engine/model/links.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"

namespace traverse {

class WallCost;  // engine/cost/wall_cost.h

// Travel of a route is the sum of the moves start -> first entry, exit -> next entry, and, if
// `finish` is set, last exit -> finish. `plan` passes CheckPlan and outlives the problem.
struct LayerProblem {
  const Plan* plan = nullptr;
  Point start;

  // Where the head goes after the layer and at what it counts in the cost: the cleaning point.
  std::optional<Point> finish;

  CostSpec cost;

  // Of this layer's own random generator.
  uint64_t seed = 1;

  // What the layer's walls add to the cost; null: there are none. Used by one call at a time.
  const WallCost* walls = nullptr;

  // What the costs of `walls` are multiplied by to be in the unit of `cost` (cost/cost_unit.h).
  double walls_unit = 1;

  // What lies between paths besides moves, and how the head came to `start`; null: nothing.
  // Searches know none (schedule/layer_solver_links.cc).
  const LayerLinks* links = nullptr;
  Departure before = {};

  // Whether routes to resume are those of a search like this one, perhaps of a layer that was a bit
  // different: then there is little to mend.
  bool is_searched = false;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_LAYER_PROBLEM_H_
