#include "engine/model/sub_plan.h"

#include <cstddef>
#include <utility>

namespace traverse {
namespace {

// Copies `node` with all below it; returns its index in the part.
int Copy(const Plan& whole, int node, SubPlan& part) {
  const PlanNode& source = whole.nodes[static_cast<size_t>(node)];
  const size_t index = part.plan.nodes.size();
  part.plan.nodes.push_back(PlanNode{source.kind, 0, {}, source.before});
  if (source.kind == PlanNode::Kind::kPath) {
    part.plan.nodes[index].path = static_cast<int>(part.path_of.size());
    part.path_of.push_back(source.path);
    part.plan.paths.push_back(whole.paths[static_cast<size_t>(source.path)]);
  }
  for (const int child : source.children) {
    const int copied = Copy(whole, child, part);
    part.plan.nodes[index].children.push_back(copied);
  }
  return static_cast<int>(index);
}

}  // namespace

SubPlan PlanBelow(const Plan& whole, int node) {
  SubPlan part;
  Copy(whole, node, part);
  return part;
}

std::vector<SubPlan> StagesOf(const Plan& whole) {
  std::vector<SubPlan> stages;
  if (whole.paths.empty()) return stages;
  if (whole.nodes.front().kind != PlanNode::Kind::kInOrder) {
    stages.push_back(PlanBelow(whole, 0));
    return stages;
  }
  for (const int child : whole.nodes.front().children) {
    SubPlan stage = PlanBelow(whole, child);
    if (!stage.path_of.empty()) stages.push_back(std::move(stage));
  }
  return stages;
}

void AppendRoute(const SubPlan& sub, const Route& part, Route& route) {
  for (const Visit& visit : part) {
    route.push_back(Visit{sub.path_of[static_cast<size_t>(visit.path)], visit.entry});
  }
}

}  // namespace traverse
