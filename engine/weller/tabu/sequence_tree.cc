#include "engine/weller/tabu/sequence_tree.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/base/resting_sort.h"

namespace traverse {
namespace {

// What it takes to look at a node, which is seldom at hand, as Rest counts steps.
constexpr size_t kStepsOfNode = 16;

}  // namespace

SequenceTree::SequenceTree(const Plan& plan, Budget* budget)
    : rest_(budget), leaf_of_(plan.paths.size(), -1) {
  if (plan.paths.empty()) return;
  nodes_.reserve(plan.nodes.size());
  Add(CompiledPlan(plan, budget), 0, -1);
  Reorder(0);
  CountViolations();
}

int SequenceTree::Add(const CompiledPlan& plan, int index, int parent) {
  rest_(kStepsOfNode);
  const PlanNode& plan_node = plan.node(index);
  const int number = node_count();
  nodes_.emplace_back();
  At(number).parent = parent;
  At(number).size = plan.path_count(index);
  if (plan.is_leaf(index)) {
    At(number).path = plan_node.path;
    leaf_of_[static_cast<size_t>(plan_node.path)] = number;
  } else {
    for (const int child : plan.children(index)) {
      const int added = Add(plan, child, number);
      At(number).order.push_back(added);
    }
    At(number).any_order = plan_node.kind == PlanNode::Kind::kAnyOrder;
    if (At(number).any_order && At(number).order.size() > 1) {
      open_.push_back(number);
      if (AddPairs(plan, index, number)) movable_.push_back(number);
      At(number).has_before = !plan_node.before.empty();
    }
  }
  At(number).subtree_end = node_count();
  return number;
}

bool SequenceTree::AddPairs(const CompiledPlan& plan, int index, int number) {
  const auto pairs = plan.SlotPairs(index);
  if (!pairs) return false;
  for (const auto& [first, second] : *pairs) {
    const int a = child_at(number, first);
    const int b = child_at(number, second);
    At(a).later.push_back(b);
    At(b).earlier.push_back(a);
  }
  return true;
}

// Writes positions and ranges below `node` anew, after its own begin.
void SequenceTree::Reorder(int node) {
  int begin = At(node).begin;
  for (int position = 0; position < child_count(node); ++position) {
    rest_(kStepsOfNode);
    const int child = child_at(node, position);
    At(child).position = position;
    At(child).begin = begin;
    begin += At(child).size;
    Reorder(child);
  }
}

void SequenceTree::CountViolations() {
  violations_ = 0;
  for (const Node& node : nodes_) {
    rest_(4 + node.later.size());
    for (const int second : node.later) violations_ += At(second).position < node.position;
  }
}

int SequenceTree::ViolationDelta(int node, int i, int j) const {
  if (!has_before(node)) return 0;
  const Node& x = At(child_at(node, i));  // moves from i to j
  const Node& y = At(child_at(node, j));  // moves from j to i
  int delta = 0;
  for (const int second : x.later) {
    const int at = position_of(second);
    delta += at > i && at <= j;
  }
  for (const int first : x.earlier) {
    const int at = position_of(first);
    delta -= at > i && at <= j;
  }
  // The pair of x and y, if there is one, was counted with x.
  for (const int first : y.earlier) {
    const int at = position_of(first);
    delta += at > i && at < j;
  }
  for (const int second : y.later) {
    const int at = position_of(second);
    delta -= at > i && at < j;
  }
  return delta;
}

void SequenceTree::Shift(int node, int by) {
  for (int v = node; v < At(node).subtree_end; ++v) At(v).begin += by;
}

void SequenceTree::Swap(int node, int i, int j) {
  violations_ += ViolationDelta(node, i, j);
  std::vector<int>& order = At(node).order;
  const int x = order[static_cast<size_t>(i)];
  const int y = order[static_cast<size_t>(j)];
  const int x_size = At(x).size;
  const int y_size = At(y).size;
  const int gap = At(y).begin - At(x).begin - x_size;
  Shift(x, gap + y_size);
  Shift(y, -gap - x_size);
  if (x_size != y_size) {
    for (int k = i + 1; k < j; ++k) Shift(order[static_cast<size_t>(k)], y_size - x_size);
  }
  std::swap(order[static_cast<size_t>(i)], order[static_cast<size_t>(j)]);
  std::swap(At(x).position, At(y).position);
}

void SequenceTree::Load(const std::vector<int>& paths) {
  for (Node& node : nodes_) node.begin = static_cast<int>(paths.size());
  for (int k = 0; k < static_cast<int>(paths.size()); ++k) {
    rest_(kStepsOfNode);
    for (int v = leaf_of_[static_cast<size_t>(paths[static_cast<size_t>(k)])]; v >= 0;
         v = At(v).parent) {
      At(v).begin = std::min(At(v).begin, k);
    }
  }
  for (const int node : open_) {
    RestingSort(At(node).order, rest_, [&](int a, int b) { return At(a).begin < At(b).begin; });
  }
  if (!nodes_.empty()) Reorder(0);
  CountViolations();
}

void SequenceTree::Shuffle(Rng& rng) {
  std::vector<int> waiting_for(nodes_.size());
  std::vector<int> ready;
  for (const int node : movable_) {
    std::vector<int>& order = At(node).order;
    ready.clear();
    for (const int child : order) {
      rest_(8);
      waiting_for[static_cast<size_t>(child)] = static_cast<int>(At(child).earlier.size());
      if (At(child).earlier.empty()) ready.push_back(child);
    }
    for (int& next : order) {
      rest_(kStepsOfNode);
      std::swap(ready[rng.Below(static_cast<uint32_t>(ready.size()))], ready.back());
      next = ready.back();
      ready.pop_back();
      for (const int second : At(next).later) {
        if (--waiting_for[static_cast<size_t>(second)] == 0) ready.push_back(second);
      }
    }
  }
  if (!nodes_.empty()) Reorder(0);
  violations_ = 0;
}

std::vector<int> SequenceTree::Paths() const {
  std::vector<int> paths(leaf_of_.size());
  for (const Node& node : nodes_) {
    rest_(4);
    if (node.path >= 0) paths[static_cast<size_t>(node.begin)] = node.path;
  }
  return paths;
}

}  // namespace traverse
