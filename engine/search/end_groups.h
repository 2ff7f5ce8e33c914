// The ends of leaves at which visits can be joined, and which of these ends are near each other.

#ifndef TRAVERSE_ENGINE_SEARCH_END_GROUPS_H_
#define TRAVERSE_ENGINE_SEARCH_END_GROUPS_H_

#include "engine/base/budget.h"
#include "engine/cost/neighbor_lists.h"
#include "engine/search/entries/leaf_entries.h"
#include "engine/search/order_tree.h"

namespace traverse {

// The point groups of neighbor lists: a contour has one, of all its entries; an open path has one
// for each end.
class EndGroups {
 public:
  // Asks `budget` regularly, if it is not null; the groups are complete in any case.
  explicit EndGroups(const LeafEntries& entries, Budget* budget = nullptr);

  const PointGroups& groups() const { return groups_; }

  static int LeafOf(int group) { return group / 2; }
  // The group of end 0 (where the path's first entry begins) or 1.
  static int GroupOf(int leaf, int end) { return 2 * leaf + end; }

 private:
  PointGroups groups_;
};

// For each end, the `count` nearest ends that the plan lets it adjoin, for every node of free order
// around it: ends of leaves with which another child of the node can begin or end. When the budget
// runs out, lists are missing. `groups` must outlive the lists.
NeighborLists FindNeighbors(const OrderTree& tree, const EndGroups& groups, int count,
                            Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_END_GROUPS_H_
