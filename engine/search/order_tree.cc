#include "engine/search/order_tree.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include "engine/base/rest.h"

namespace traverse {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

// Turns pairs of an item and its list entry into one array, with the index where each item's part
// begins; in the order of the pairs.
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
  Compiler(const CompiledPlan& plan, OrderTree& tree, Budget* budget)
      : plan_(plan), tree_(tree), budget_(budget), rest_(budget) {}

  void Run() {
    const size_t leaves = static_cast<size_t>(tree_.leaf_count());
    Resize(leaves);
    std::fill_n(tree_.size_.begin(), leaves, 1);
    const std::vector<Path>& paths = plan_.plan().paths;
    for (size_t p = 0; p < paths.size(); ++p) {
      rest_();
      tree_.reversible_[p] = CanReverse(paths[p]);
    }
    const int root = NewItem(false);
    std::vector<int> children = {tree_.start()};
    if (plan_.node_count() > 0 && plan_.path_count(0) > 0) children.push_back(Compile(0));
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

  // Returns the item that represents a node. REQUIRES: there are leaves below it.
  int Compile(int index) {
    const PlanNode& node = plan_.node(index);
    if (node.kind == PlanNode::Kind::kPath) return node.path;
    rest_(8 + 4 * node.children.size());
    const absl::Span<const int> children = plan_.children(index);
    const bool any_order = node.kind == PlanNode::Kind::kAnyOrder;
    const int item = children.size() > 1 ? NewItem(any_order) : -1;
    tree_.has_choice_ = tree_.has_choice_ || (any_order && children.size() > 1);
    std::vector<int> items;
    for (const int child : children) items.push_back(Compile(child));
    assert(!items.empty());
    if (items.size() == 1) return items[0];
    if (tree_.free_order(item)) AddPairs(index, item, items);
    Adopt(item, items);
    return item;
  }

  // Where the pairs are too many, the children stay in the order of the route that is searched
  // from.
  void AddPairs(int index, int item, const std::vector<int>& items) {
    rest_(4 * plan_.node(index).before.size());
    const auto pairs = plan_.SlotPairs(index, budget_);
    tree_.free_order_[Index(item)] = pairs.has_value();
    if (!pairs) return;
    for (const auto& [first, second] : *pairs) {
      const int a = items[Index(first)];
      const int b = items[Index(second)];
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

  const CompiledPlan& plan_;
  OrderTree& tree_;
  Budget* const budget_;
  Pairs after_, before_, children_;  // of an item, and the other one
  Rest rest_;
};

OrderTree::OrderTree(const CompiledPlan& plan, Budget* budget)
    : start_(static_cast<int>(plan.plan().paths.size())) {
  Compiler(plan, *this, budget).Run();
}

OrderTree::OrderTree(const Plan& plan, Budget* budget)
    : OrderTree(CompiledPlan(plan, budget), budget) {}

}  // namespace traverse
