#include "engine/model/tree/compiled_plan.h"

#include <cstddef>

#include "engine/base/rest.h"
#include "engine/model/tree/passed_pairs.h"

namespace traverse {

CompiledPlan::CompiledPlan(const Plan& plan, Budget* budget) : plan_(&plan) {
  CountPaths(budget);
  ListChildren(budget);
}

// From the leaves up: children have greater indices than their parents.
void CompiledPlan::CountPaths(Budget* budget) {
  Rest rest(budget);
  parent_.assign(plan_->nodes.size(), -1);
  path_count_.assign(plan_->nodes.size(), 0);
  leaf_.assign(plan_->paths.size(), -1);
  for (int index = node_count(); index-- > 0;) {
    rest(1 + node(index).children.size());
    int& count = path_count_[static_cast<size_t>(index)];
    if (is_leaf(index)) {
      count = 1;
      leaf_[static_cast<size_t>(node(index).path)] = index;
    }
    for (const int child : node(index).children) {
      parent_[static_cast<size_t>(child)] = index;
      count += path_count(child);
    }
  }
}

void CompiledPlan::ListChildren(Budget* budget) {
  Rest rest(budget);
  first_child_.reserve(plan_->nodes.size() + 1);
  for (const PlanNode& node : plan_->nodes) {
    rest(1 + node.children.size());
    first_child_.push_back(static_cast<int>(children_.size()));
    for (const int child : node.children) {
      if (path_count(child) > 0) children_.push_back(child);
    }
  }
  first_child_.push_back(static_cast<int>(children_.size()));
}

std::optional<std::vector<std::pair<int, int>>> CompiledPlan::SlotPairs(int index,
                                                                        Budget* budget) const {
  const std::vector<int>& all = node(index).children;
  std::optional<std::vector<std::pair<int, int>>> pairs(std::in_place);
  if (node(index).before.empty()) return pairs;
  Rest rest(budget);
  rest(4 * all.size());
  std::vector<bool> has_paths;
  std::vector<int> slot_of;  // of children without paths: that of the next one that has some
  int slots = 0;
  for (const int child : all) {
    has_paths.push_back(path_count(child) > 0);
    slot_of.push_back(slots);
    slots += path_count(child) > 0 ? 1 : 0;
  }
  pairs = PassedPairs(node(index), has_paths, budget);
  if (!pairs || slots == static_cast<int>(all.size())) return pairs;
  for (auto& [first, second] : *pairs) {
    rest(2);
    first = slot_of[static_cast<size_t>(first)];
    second = slot_of[static_cast<size_t>(second)];
  }
  return pairs;
}

}  // namespace traverse
