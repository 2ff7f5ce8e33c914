#include "engine/model/route.h"

#include <cstddef>
#include <functional>
#include <queue>
#include <vector>

#include "engine/base/rest.h"

namespace traverse {
namespace {

// The children of `node` in the first order that keeps its pairs.
std::vector<int> ChildrenInGivenOrder(const PlanNode& node, Rest& rest) {
  if (node.before.empty()) return node.children;
  std::vector<std::vector<int>> later(node.children.size());
  std::vector<int> waiting_for(node.children.size());
  for (const auto& [first, second] : node.before) {
    rest(2);
    later[static_cast<size_t>(first)].push_back(second);
    ++waiting_for[static_cast<size_t>(second)];
  }
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;
  for (size_t i = 0; i < waiting_for.size(); ++i) {
    if (waiting_for[i] == 0) ready.push(static_cast<int>(i));
  }
  std::vector<int> order;
  while (!ready.empty()) {
    rest(16);
    const size_t child = static_cast<size_t>(ready.top());
    ready.pop();
    order.push_back(node.children[child]);
    for (const int second : later[child]) {
      if (--waiting_for[static_cast<size_t>(second)] == 0) ready.push(second);
    }
  }
  return order;
}

void AppendGiven(const Plan& plan, int index, Rest& rest, Route& route) {
  rest(2);
  const PlanNode& node = plan.nodes[static_cast<size_t>(index)];
  if (node.kind == PlanNode::Kind::kPath) {
    route.push_back(Visit{node.path, GivenEntry(plan.paths[static_cast<size_t>(node.path)])});
    return;
  }
  for (const int child : ChildrenInGivenOrder(node, rest)) AppendGiven(plan, child, rest, route);
}

}  // namespace

Route GivenRoute(const Plan& plan, Budget* budget) {
  Rest rest(budget);
  Route route;
  route.reserve(plan.paths.size());
  if (!plan.nodes.empty()) AppendGiven(plan, 0, rest, route);
  return route;
}

}  // namespace traverse
