#include "engine/search/order_tree.h"

#include <algorithm>
#include <cstddef>

#include "engine/model/passed_pairs.h"

namespace traverse {
namespace {

using Lists = std::vector<std::vector<int>>;

// Turns one list an item into one array with the place where each item's part begins.
void Flatten(const Lists& lists, std::vector<int>& values, std::vector<int>& first) {
  first.reserve(lists.size() + 1);
  for (const std::vector<int>& list : lists) {
    first.push_back(static_cast<int>(values.size()));
    values.insert(values.end(), list.begin(), list.end());
  }
  first.push_back(static_cast<int>(values.size()));
}

bool CanReverse(const Path& path) { return path.kind == Path::Kind::kContour || !path.one_way; }

}  // namespace

// Builds the items from the plan's nodes, children first.
class OrderTree::Compiler {
 public:
  Compiler(const Plan& plan, OrderTree& tree) : plan_(plan), tree_(tree) {}

  void Run() {
    CountLeaves();
    const size_t leaves = static_cast<size_t>(tree_.leaf_count());
    Resize(leaves);
    std::fill_n(tree_.size_.begin(), leaves, 1);
    for (size_t p = 0; p < plan_.paths.size(); ++p) {
      tree_.reversible_[p] = CanReverse(plan_.paths[p]);
    }
    const int root = NewItem(false);
    std::vector<int> children = {tree_.start()};
    if (!plan_.nodes.empty() && leaves_[0] > 0) children.push_back(Compile(0));
    children.push_back(tree_.finish());
    Adopt(root, children);
    tree_.parent_[Index(root)] = -1;
    SetDepths();
    Flatten(after_, tree_.after_, tree_.after_first_);
    Flatten(before_, tree_.before_, tree_.before_first_);
    Flatten(children_, tree_.children_, tree_.children_first_);
  }

 private:
  // Children have larger indices than their parents.
  void CountLeaves() {
    leaves_.resize(plan_.nodes.size());
    for (size_t i = plan_.nodes.size(); i-- > 0;) {
      const PlanNode& node = plan_.nodes[i];
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
    after_.resize(items);
    before_.resize(items);
    children_.resize(items);
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
    std::vector<bool> has_leaves;
    for (const int child : item_of) has_leaves.push_back(child >= 0);
    const auto pairs = PassedPairs(node, has_leaves);
    tree_.free_order_[Index(item)] = pairs.has_value();
    if (!pairs) return;
    for (const auto& [first, second] : *pairs) {
      const int a = item_of[Index(first)];
      const int b = item_of[Index(second)];
      after_[Index(a)].push_back(b);
      before_[Index(b)].push_back(a);
    }
  }

  void Adopt(int item, const std::vector<int>& children) {
    const size_t i = Index(item);
    bool pairs = false;
    bool reversible = true;
    for (const int child : children) {
      tree_.parent_[Index(child)] = item;
      tree_.size_[i] += tree_.size(child);
      pairs = pairs || !after_[Index(child)].empty();
      reversible = reversible && tree_.reversible(child);
    }
    tree_.has_pairs_[i] = pairs;
    tree_.children_reversible_[i] = reversible;
    tree_.reversible_[i] = reversible && !pairs && tree_.free_order(item);
    children_[i] = children;
  }

  // Parents were numbered before their children, leaves apart.
  void SetDepths() {
    for (int item = tree_.root() + 1; item < tree_.item_count(); ++item) SetDepth(item);
    for (int leaf = 0; leaf < tree_.leaf_count(); ++leaf) SetDepth(leaf);
    // Below a node of free order, all nodes can change place.
    std::vector<char> can_move(tree_.parent_.size());
    for (int item = tree_.root() + 1; item < tree_.item_count(); ++item) {
      const int parent = tree_.parent(item);
      can_move[Index(item)] = tree_.free_order(parent) || can_move[Index(parent)];
      tree_.nested_ = tree_.nested_ || can_move[Index(item)];
    }
  }
  void SetDepth(int item) { tree_.depth_[Index(item)] = tree_.depth(tree_.parent(item)) + 1; }

  const Plan& plan_;
  OrderTree& tree_;
  std::vector<int> leaves_;  // [node] leaves below
  Lists after_, before_, children_;
};

OrderTree::OrderTree(const Plan& plan) : start_(static_cast<int>(plan.paths.size())) {
  Compiler(plan, *this).Run();
}

}  // namespace traverse
