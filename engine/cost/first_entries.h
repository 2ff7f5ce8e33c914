// Where the parts of a plan may begin.

#ifndef TRAVERSE_ENGINE_COST_FIRST_ENTRIES_H_
#define TRAVERSE_ENGINE_COST_FIRST_ENTRIES_H_

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/cost/layer_view.h"
#include "engine/model/tree/plan_tree.h"

namespace traverse {

// The leaf, or the any_order node, with which `node` begins. REQUIRES: it has paths.
inline int Beginning(const PlanTree& tree, int node) {
  while (tree.node(node).kind == PlanNode::Kind::kInOrder) {
    assert(!tree.children(node).empty());
    node = tree.children(node)[0];
  }
  return node;
}

// Calls `f(entry)` for entries of the layer's table at which `node` may begin. If it begins with a
// leaf, these are all entries of it. Otherwise they are about `limit` or fewer, at least one,
// evenly spread over the children that may come first. O(entries) for a leaf, else O(limit +
// children) per level of nested nodes.
template <typename F>
void ForEachFirstEntry(const LayerView& layer, int node, size_t limit, F&& f, bool all = true) {
  node = Beginning(layer.tree, node);
  if (layer.tree.is_leaf(node)) {
    const size_t first = static_cast<size_t>(layer.table.first(layer.tree.node(node).path));
    const size_t count = static_cast<size_t>(layer.table.count(layer.tree.node(node).path));
    const size_t step = all ? 1 : (count + limit - 1) / limit;
    for (size_t i = 0; i < count; i += step) f(static_cast<int>(first + i));
    return;
  }
  const absl::Span<const int> children = layer.tree.children(node);
  std::vector<int> ready;
  const ReadySlots slots(layer.tree.precedence(node), static_cast<int>(children.size()),
                         [&](int slot) { ready.push_back(children[static_cast<size_t>(slot)]); });
  const size_t step = (ready.size() + limit - 1) / limit;
  const size_t each = std::max<size_t>(1, limit * step / ready.size());
  for (size_t i = 0; i < ready.size(); i += step) {
    ForEachFirstEntry(layer, ready[i], each, f, false);
  }
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_FIRST_ENTRIES_H_
