// A problem together with what algorithms derive from it before they begin.

#ifndef TRAVERSE_ENGINE_COST_LAYER_VIEW_H_
#define TRAVERSE_ENGINE_COST_LAYER_VIEW_H_

#include "engine/cost/entry_table.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layer_problem.h"
#include "engine/model/tree/plan_tree.h"

namespace traverse {

// Immutable; O(points + nodes + pairs) to build.
struct LayerView {
  // `problem` and its plan must outlive the view. Asks `budget` regularly, if it is not null.
  explicit LayerView(const LayerProblem& layer_problem, Budget* budget = nullptr)
      : problem(layer_problem),
        tree(*problem.plan, budget),
        table(*problem.plan, budget),
        cost(problem) {}

  const Plan& plan() const { return *problem.plan; }

  const LayerProblem& problem;
  const PlanTree tree;
  const EntryTable table;
  const TravelCost cost;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_LAYER_VIEW_H_
