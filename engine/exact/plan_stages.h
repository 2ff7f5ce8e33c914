// The stages of a plan: which plans are an in_order of any_orders over paths, and which are not.

#ifndef TRAVERSE_ENGINE_EXACT_PLAN_STAGES_H_
#define TRAVERSE_ENGINE_EXACT_PLAN_STAGES_H_

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "engine/model/plan.h"

namespace traverse {

// Paths that are done in any order that keeps `before`.
struct PlanStage {
  std::vector<int> paths;                   // indices into Plan::paths, at least one
  std::vector<std::pair<int, int>> before;  // positions in `paths`; transitively closed
};

// The stages of `plan`, done one after the other, or nothing if a child of an any_order with others
// holds more than one path, or an any_order has more than `most_children`. Nested in_orders are
// flattened; nodes without paths vanish, but the precedences that go through them are kept.
// O(nodes + children^3) for any_orders with `before`.
std::optional<std::vector<PlanStage>> StagesOf(const Plan& plan, size_t most_children);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_EXACT_PLAN_STAGES_H_
