#include "engine/model/two_layers.h"

namespace traverse {
namespace {

// Appends `plan` as the last child of the root.
void AppendChild(const Plan& plan, Plan& both) {
  if (plan.nodes.empty()) return;
  const int first_node = static_cast<int>(both.nodes.size());
  const int first_path = static_cast<int>(both.paths.size());
  both.nodes[0].children.push_back(first_node);
  both.paths.insert(both.paths.end(), plan.paths.begin(), plan.paths.end());
  for (const PlanNode& node : plan.nodes) {
    PlanNode& copy = both.nodes.emplace_back(node);
    if (copy.kind == PlanNode::Kind::kPath) copy.path += first_path;
    for (int& child : copy.children) child += first_node;
  }
}

}  // namespace

Plan PlanOfBoth(const Plan& first, const Plan& second) {
  Plan both;
  both.paths.reserve(first.paths.size() + second.paths.size());
  both.nodes.reserve(first.nodes.size() + second.nodes.size() + 1);
  both.nodes.push_back({PlanNode::Kind::kInOrder, 0, {}, {}});
  AppendChild(first, both);
  AppendChild(second, both);
  return both;
}

Route RouteOfBoth(const Route& first, const Route& second, int paths) {
  Route both = first;
  for (const Visit& visit : second) both.push_back({visit.path + paths, visit.entry});
  return both;
}

Route RouteOfFirst(const Route& both, int paths) {
  return Route(both.begin(), both.begin() + paths);
}

Route RouteOfSecond(const Route& both, int paths) {
  Route second(both.begin() + paths, both.end());
  for (Visit& visit : second) visit.path -= paths;
  return second;
}

}  // namespace traverse
