// A part of a plan as a plan of its own.

#ifndef TRAVERSE_ENGINE_MODEL_SUB_PLAN_H_
#define TRAVERSE_ENGINE_MODEL_SUB_PLAN_H_

#include <vector>

#include "engine/model/plan.h"
#include "engine/model/route.h"

namespace traverse {

struct SubPlan {
  Plan plan;
  std::vector<int> path_of;  // [path of `plan`] index into the whole plan's paths
};

// The part of `whole` below `node`, with the same tree. O(nodes and points below).
SubPlan PlanBelow(const Plan& whole, int node);

// The parts of a plan that are done one after the other: the children of an in_order root, without
// those that have no paths, or else the whole plan. O(plan).
std::vector<SubPlan> StagesOf(const Plan& whole);

// Appends `part`, a route of `sub`, to a route of the whole plan.
void AppendRoute(const SubPlan& sub, const Route& part, Route& route);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_SUB_PLAN_H_
