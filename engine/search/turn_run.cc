#include "engine/search/turn_run.h"

#include <algorithm>
#include <cassert>

#include "engine/search/segment_move.h"

namespace traverse {
namespace {

using Kind = SegmentMove::Kind;

// Whether no child that must come before `child` is at [first, last].
bool MayComeFirst(const SearchState& state, int child, int first, int last) {
  const auto before = state.tree().before(child);
  return std::none_of(before.begin(), before.end(), [&](int other) {
    return state.position(other) >= first && state.position(other) <= last;
  });
}

[[maybe_unused]] bool IsUnionOfChildren(const SearchState& state, int node, int first, int last) {
  const OrderTree& tree = state.tree();
  const int begin = tree.ChildHolding(node, state.leaf_at(first));
  const int end = tree.ChildHolding(node, state.leaf_at(last));
  return state.position(begin) == first && state.position(end) + tree.size(end) - 1 == last;
}

void TurnItem(SearchState& state, int item) {
  const OrderTree& tree = state.tree();
  const int first = state.position(item);
  const int last = first + tree.size(item) - 1;
  if (tree.reversible(item)) {
    state.Apply({Kind::kReverse, first, first, last});
  } else if (tree.free_order(item)) {
    TurnRun(state, item, first, last);
  } else {
    for (const int child : tree.children(item)) TurnItem(state, child);
  }
}

}  // namespace

bool TurnsOnly(const OrderTree& tree, int node) {
  return tree.free_order(node) && (!tree.children_reversible(node) || tree.has_pairs(node));
}

void TurnRun(SearchState& state, int node, int first, int last) {
  const OrderTree& tree = state.tree();
  assert(tree.free_order(node) && IsUnionOfChildren(state, node, first, last));
  // Of the remaining children, moves the last that may come now to the front. There always is one:
  // the first one has nothing before it.
  for (int begin = first; begin < last;) {
    int end = last;
    int child = tree.ChildHolding(node, state.leaf_at(end));
    while (!MayComeFirst(state, child, begin, end - tree.size(child))) {
      end -= tree.size(child);
      child = tree.ChildHolding(node, state.leaf_at(end));
    }
    const int child_begin = end - tree.size(child) + 1;
    if (child_begin > begin) state.Apply({Kind::kExchange, begin, child_begin, end});
    begin += tree.size(child);
  }
  for (int at = first; at <= last;) {
    const int child = tree.ChildHolding(node, state.leaf_at(at));
    TurnItem(state, child);
    at += tree.size(child);
  }
}

}  // namespace traverse
