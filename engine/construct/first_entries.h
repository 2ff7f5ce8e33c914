// Where the parts of a plan may be begun.

#ifndef TRAVERSE_ENGINE_CONSTRUCT_FIRST_ENTRIES_H_
#define TRAVERSE_ENGINE_CONSTRUCT_FIRST_ENTRIES_H_

#include "absl/types/span.h"
#include "engine/cost/layer_view.h"
#include "engine/model/plan_tree.h"

namespace traverse {

// Calls `f(entry)` for each entry of the layer's table at which `node` may be begun: those of its
// leaf, of its first child, or of each child that waits for no other one. O(nodes below + entries).
template <typename F>
void ForEachFirstEntry(const LayerView& layer, int node, F&& f) {
  const absl::Span<const int> children = layer.tree.children(node);
  if (layer.tree.is_leaf(node)) {
    const int path = layer.tree.node(node).path;
    for (int e = layer.table.first(path); e < layer.table.first(path + 1); ++e) f(e);
  } else if (layer.tree.node(node).kind == PlanNode::Kind::kInOrder) {
    if (!children.empty()) ForEachFirstEntry(layer, children[0], f);
  } else {
    ReadySlots(layer.tree.precedence(node), static_cast<int>(children.size()),
               [&](int slot) { ForEachFirstEntry(layer, children[static_cast<size_t>(slot)], f); });
  }
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_CONSTRUCT_FIRST_ENTRIES_H_
