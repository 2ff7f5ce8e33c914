#include "engine/weller/step_problem.h"

#include "engine/base/rng.h"

namespace traverse {

void ArrangeFreely(Plan& plan) {
  plan.nodes.assign(1, PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
  for (int path = 0; path < static_cast<int>(plan.paths.size()); ++path) {
    plan.nodes[0].children.push_back(path + 1);
    plan.nodes.push_back(PlanNode{PlanNode::Kind::kPath, path, {}, {}});
  }
}

LayerProblem StepProblem(const LayerProblem& problem, const Plan& plan, uint64_t step) {
  LayerProblem sub;
  sub.plan = &plan;
  sub.start = problem.start;
  sub.cost = problem.cost;
  sub.walls = problem.walls;
  sub.walls_unit = problem.walls_unit;
  sub.seed = StreamSeed(problem.seed, step);
  return sub;
}

}  // namespace traverse
