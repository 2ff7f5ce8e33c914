#include "engine/search/end_groups.h"

#include <vector>

#include "engine/base/rest.h"

namespace traverse {
namespace {

using Member = NeighborLists::Member;

// Appends the ends of all leaves with which `item` can begin or end. Ignores pairs.
void AppendEnds(const OrderTree& tree, const PointGroups& groups, int item, int owner,
                std::vector<Member>& members) {
  if (item < tree.leaf_count()) {
    for (const int end : {0, 1}) {
      const int group = EndGroups::GroupOf(item, end);
      if (!groups.of(group).empty()) members.push_back({group, owner});
    }
    return;
  }
  const absl::Span<const int> children = tree.children(item);
  if (tree.free_order(item)) {
    for (const int child : children) AppendEnds(tree, groups, child, owner, members);
  } else {
    AppendEnds(tree, groups, children.front(), owner, members);
    AppendEnds(tree, groups, children.back(), owner, members);
  }
}

}  // namespace

EndGroups::EndGroups(const LeafEntries& entries, Budget* budget) {
  Rest rest(budget);
  for (int leaf = 0; leaf + 2 < entries.leaf_count(); ++leaf) {
    rest(4);
    const int first = entries.first(leaf);
    if (entries.open(leaf)) {
      groups_.points.push_back(entries.enter(first));
      groups_.Close();
      groups_.points.push_back(entries.exit(first));
    } else {
      for (int i = 0; i < entries.count(leaf); ++i) {
        groups_.points.push_back(entries.enter(first + i));
        rest(2);
      }
      groups_.Close();
    }
    groups_.Close();
  }
}

NeighborLists FindNeighbors(const OrderTree& tree, const EndGroups& groups, int count,
                            Budget& budget) {
  NeighborLists lists(groups.groups());
  std::vector<Member> members;
  Rest rest(&budget);
  for (int node = tree.root() + 1; node < tree.item_count(); ++node) {
    rest();
    if (!tree.free_order(node)) continue;
    members.clear();
    for (const int child : tree.children(node)) {
      rest(8 * static_cast<size_t>(tree.size(child)));
      AppendEnds(tree, groups.groups(), child, child, members);
    }
    lists.FindAmong(members, count, budget);
  }
  lists.Seal(&budget);
  return lists;
}

}  // namespace traverse
