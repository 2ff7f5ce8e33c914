#include "engine/model/tree/plan_tree.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include "engine/base/rest.h"

namespace traverse {

Precedence::Precedence(const PlanNode& node, int slots, const std::vector<int>& item_of)
    : slots_(slots), first_pair_(item_of.size() + 1), pairs_(node.before.size()) {
  const auto item = [&](int child) { return item_of[static_cast<size_t>(child)]; };
  std::vector<int> waiting_for(item_of.size());
  for (const auto& [first, second] : node.before) {
    ++first_pair_[static_cast<size_t>(item(first)) + 1];
    ++waiting_for[static_cast<size_t>(item(second))];
  }
  for (size_t i = 0; i < item_of.size(); ++i) first_pair_[i + 1] += first_pair_[i];
  std::vector<int> next(first_pair_.begin(), first_pair_.end() - 1);
  for (const auto& [first, second] : node.before) {
    pairs_[static_cast<size_t>(next[static_cast<size_t>(item(first))]++)] = item(second);
  }

  for (size_t i = 0; i < waiting_for.size(); ++i) {
    if (waiting_for[i] == 0) topological_.push_back(static_cast<int>(i));
  }
  for (size_t i = 0; i < topological_.size(); ++i) {
    for (const int after : After(topological_[i])) {
      if (--waiting_for[static_cast<size_t>(after)] == 0) topological_.push_back(after);
    }
  }
}

void Precedence::LastBefore(absl::Span<const int> position, std::vector<int>& last) const {
  assert(!empty());
  last.assign(topological_.size(), -1);
  for (const int item : topological_) {
    const size_t index = static_cast<size_t>(item);
    const int end = item < slots_ ? position[index] : last[index];
    for (const int after : After(item)) {
      int& latest = last[static_cast<size_t>(after)];
      latest = std::max(latest, end);
    }
  }
}

std::vector<uint64_t> Precedence::SlotsBefore(int first) const {
  assert(!empty());
  std::vector<uint64_t> before(topological_.size());
  const int end = std::min(first + 64, slots_);
  for (const int item : topological_) {
    uint64_t slots = before[static_cast<size_t>(item)];
    if (item >= first && item < end) slots |= uint64_t{1} << (item - first);
    if (slots == 0) continue;
    for (const int after : After(item)) before[static_cast<size_t>(after)] |= slots;
  }
  return before;
}

PlanTree::PlanTree(const Plan& plan, Budget* budget)
    : CompiledPlan(plan, budget),
      precedence_of_(plan.nodes.size()),
      precedences_(1),
      reversible_(plan.nodes.size()) {
  Rest rest(budget);
  for (int index = node_count(); index-- > 0;) {
    rest(1 + node(index).children.size() + node(index).before.size());
    if (!node(index).before.empty()) AddPrecedence(index);
    reversible_[static_cast<size_t>(index)] = ComputeReversible(index);
  }
}

void PlanTree::AddPrecedence(int index) {
  const std::vector<int>& all = node(index).children;
  const int slots = static_cast<int>(children(index).size());
  std::vector<int> item_of;
  item_of.reserve(all.size());
  int slot = 0;
  int other = slots;
  for (const int child : all) item_of.push_back(path_count(child) > 0 ? slot++ : other++);
  precedence_of_[static_cast<size_t>(index)] = static_cast<int>(precedences_.size());
  precedences_.emplace_back(node(index), slots, item_of);
}

bool PlanTree::ComputeReversible(int index) const {
  if (is_leaf(index)) return !plan().paths[static_cast<size_t>(node(index).path)].one_way;
  const absl::Span<const int> below = children(index);
  const bool free_order =
      node(index).kind == PlanNode::Kind::kAnyOrder && precedence(index).empty();
  return (free_order || below.size() <= 1) &&
         std::all_of(below.begin(), below.end(), [&](int child) { return reversible(child); });
}

}  // namespace traverse
