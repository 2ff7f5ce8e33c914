#include "engine/model/layers_in_order.h"

#include <cassert>
#include <cstddef>

namespace traverse {
namespace {

// Appends `plan` as the last child of the root.
void AppendChild(const Plan& plan, Plan& all) {
  if (plan.nodes.empty()) return;
  const int first_node = static_cast<int>(all.nodes.size());
  const int first_path = static_cast<int>(all.paths.size());
  all.nodes[0].children.push_back(first_node);
  all.paths.insert(all.paths.end(), plan.paths.begin(), plan.paths.end());
  for (const PlanNode& node : plan.nodes) {
    PlanNode& copy = all.nodes.emplace_back(node);
    if (copy.kind == PlanNode::Kind::kPath) copy.path += first_path;
    for (int& child : copy.children) child += first_node;
  }
}

}  // namespace

Plan PlanInOrder(absl::Span<const Plan* const> layers) {
  size_t paths = 0;
  size_t nodes = 1;
  for (const Plan* layer : layers) {
    paths += layer->paths.size();
    nodes += layer->nodes.size();
  }
  Plan all;
  all.paths.reserve(paths);
  all.nodes.reserve(nodes);
  all.nodes.push_back({PlanNode::Kind::kInOrder, 0, {}, {}});
  for (const Plan* layer : layers) AppendChild(*layer, all);
  return all;
}

Route RouteInOrder(absl::Span<const Route* const> routes) {
  Route all;
  int first_path = 0;
  for (const Route* route : routes) {
    for (const Visit& visit : *route) all.push_back({visit.path + first_path, visit.entry});
    first_path += static_cast<int>(route->size());
  }
  return all;
}

std::vector<Route> RoutesOfEach(absl::Span<const Plan* const> layers, const Route& route) {
  std::vector<Route> routes;
  auto begin = route.begin();
  int first_path = 0;
  for (const Plan* layer : layers) {
    const int paths = static_cast<int>(layer->paths.size());
    assert(paths <= route.end() - begin);
    Route& own = routes.emplace_back(begin, begin + paths);
    for (Visit& visit : own) {
      visit.path -= first_path;
      assert(visit.path >= 0 && visit.path < paths);
    }
    begin += paths;
    first_path += paths;
  }
  assert(begin == route.end());
  return routes;
}

}  // namespace traverse
