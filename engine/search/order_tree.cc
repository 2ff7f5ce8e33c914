#include "engine/search/order_tree.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/base/rest.h"
#include "engine/model/passed_pairs.h"

namespace traverse {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

// Turns pairs of an item and what is listed for it into one array, with the place where each item's
// part begins; in the order of the pairs.
void Group(const Pairs& pairs, size_t items, Rest& rest, std::vector<int>& values,
           std::vector<int>& first) {
  first.assign(items + 2, 0);
  for (const auto& [item, value] : pairs) {
    rest(2);
    ++first[static_cast<size_t>(item) + 2];
  }
  for (size_t i = 2; i < first.size(); ++i) first[i] += first[i - 1];
  values.resize(pairs.size());
  for (const auto& [item, value] : pairs) {
    rest(4);
    values[static_cast<size_t>(first[static_cast<size_t>(item) + 1]++)] = value;
  }
  first.pop_back();
}

bool CanReverse(const Path& path) { return path.kind == Path::Kind::kContour || !path.one_way; }

}  // namespace

// Builds the items from the plan's nodes, children first.
class OrderTree::Compiler {
 public:
  Compiler(const Plan& plan, OrderTree& tree, Budget* budget)
      : plan_(plan), tree_(tree), budget_(budget), rest_(budget) {}

  void Run() {
    CountLeaves();
    const size_t leaves = static_cast<size_t>(tree_.leaf_count());
    Resize(leaves);
    std::fill_n(tree_.size_.begin(), leaves, 1);
    for (size_t p = 0; p < plan_.paths.size(); ++p) {
      rest_();
      tree_.reversible_[p] = CanReverse(plan_.paths[p]);
    }
    const int root = NewItem(false);
    std::vector<int> children = {tree_.start()};
    if (!plan_.nodes.empty() && leaves_[0] > 0) children.push_back(Compile(0));
    children.push_back(tree_.finish());
    Adopt(root, children);
    tree_.parent_[Index(root)] = -1;
    SetDepths();
    const size_t items = tree_.parent_.size();
    Group(after_, items, rest_, tree_.after_, tree_.after_first_);
    Group(before_, items, rest_, tree_.before_, tree_.before_first_);
    Group(children_, items, rest_, tree_.children_, tree_.children_first_);
  }

 private:
  // Children have larger indices than their parents.
  void CountLeaves() {
    leaves_.resize(plan_.nodes.size());
    for (size_t i = plan_.nodes.size(); i-- > 0;) {
      const PlanNode& node = plan_.nodes[i];
      rest_(1 + node.children.size());
      leaves_[i] = node.kind == PlanNode::Kind::kPath;
      for (const int child : node.children) leaves_[i] += leaves_[Index(child)];
    }
  }

  void Resize(size_t items) {
    tree_.parent_.resize(items, -1);
    tree_.depth_.resize(items);
    tree_.size_.resize(items);
    tree_.free_order_.resize(items);
    tree_.reversible_.resize(items);
    tree_.children_reversible_.resize(items);
    tree_.has_pairs_.resize(items);
  }

  int NewItem(bool free_order) {
    const int item = tree_.item_count();
    Resize(tree_.parent_.size() + 1);
    tree_.free_order_[Index(item)] = free_order;
    return item;
  }

  // Returns the item that stands for a node. REQUIRES: there are leaves below it.
  int Compile(int index) {
    const PlanNode& node = plan_.nodes[Index(index)];
    if (node.kind == PlanNode::Kind::kPath) return node.path;
    rest_(8 + 4 * node.children.size());
    std::vector<int> items;  // of the children with leaves
    std::vector<int> item_of(node.children.size(), -1);
    const auto with_leaves = std::count_if(node.children.begin(), node.children.end(),
                                           [&](int child) { return leaves_[Index(child)] > 0; });
    const bool any_order = node.kind == PlanNode::Kind::kAnyOrder;
    const int item = with_leaves > 1 ? NewItem(any_order) : -1;
    tree_.has_choice_ = tree_.has_choice_ || (any_order && with_leaves > 1);
    for (size_t c = 0; c < node.children.size(); ++c) {
      if (leaves_[Index(node.children[c])] == 0) continue;
      items.push_back(item_of[c] = Compile(node.children[c]));
    }
    if (items.size() == 1) return items[0];
    if (tree_.free_order(item)) AddPairs(node, item, item_of);
    Adopt(item, items);
    return item;
  }

  // Passes pairs on through children without leaves: a before empty before b is a before b. Where
  // that comes to too many, the children stay in the order of the route that is searched from.
  void AddPairs(const PlanNode& node, int item, const std::vector<int>& item_of) {
    rest_(4 * node.before.size());
    std::vector<bool> has_leaves;
    for (const int child : item_of) has_leaves.push_back(child >= 0);
    const auto pairs = PassedPairs(node, has_leaves, budget_);
    tree_.free_order_[Index(item)] = pairs.has_value();
    if (!pairs) return;
    for (const auto& [first, second] : *pairs) {
      const int a = item_of[Index(first)];
      const int b = item_of[Index(second)];
      rest_(2);
      after_.emplace_back(a, b);
      before_.emplace_back(b, a);
    }
    tree_.has_pairs_[Index(item)] = !pairs->empty();
  }

  void Adopt(int item, const std::vector<int>& children) {
    const size_t i = Index(item);
    bool reversible = true;
    for (const int child : children) {
      rest_();
      tree_.parent_[Index(child)] = item;
      tree_.size_[i] += tree_.size(child);
      reversible = reversible && tree_.reversible(child);
      children_.emplace_back(item, child);
    }
    tree_.children_reversible_[i] = reversible;
    tree_.reversible_[i] = reversible && !tree_.has_pairs(item) && tree_.free_order(item);
  }

  // Parents were numbered before their children, leaves apart.
  void SetDepths() {
    for (int item = tree_.root() + 1; item < tree_.item_count(); ++item) SetDepth(item);
    for (int leaf = 0; leaf < tree_.leaf_count(); ++leaf) SetDepth(leaf);
    // Below a node of free order, all nodes can change place.
    std::vector<char> can_move(tree_.parent_.size());
    for (int item = tree_.root() + 1; item < tree_.item_count(); ++item) {
      rest_();
      const int parent = tree_.parent(item);
      can_move[Index(item)] = tree_.free_order(parent) || can_move[Index(parent)];
      tree_.nested_ = tree_.nested_ || can_move[Index(item)];
    }
  }
  void SetDepth(int item) {
    rest_();
    tree_.depth_[Index(item)] = tree_.depth(tree_.parent(item)) + 1;
  }

  const Plan& plan_;
  OrderTree& tree_;
  Budget* const budget_;
  std::vector<int> leaves_;          // [node] leaves below
  Pairs after_, before_, children_;  // of an item, and the other one
  Rest rest_;
};

OrderTree::OrderTree(const Plan& plan, Budget* budget)
    : start_(static_cast<int>(plan.paths.size())) {
  Compiler(plan, *this, budget).Run();
}

}  // namespace traverse
