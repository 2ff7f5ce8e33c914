// The route that a local search changes: visits in flat arrays, and the position of each node of
// the plan's tree in them.

#ifndef TRAVERSE_ENGINE_SOUZA_SEARCH_ROUTE_H_
#define TRAVERSE_ENGINE_SOUZA_SEARCH_ROUTE_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/rest.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// Loaded from a route and unloaded into one. Every change keeps it valid if its REQUIRES hold. Not
// thread-safe.
//
// The paths below a node are visited without interruption, at positions [begin(node), begin(node) +
// path_count(node)). For an any_order node, order(node) lists the slots (PlanTree::children) as
// they follow each other.
//
// It also notes what a search still has to look at: a node or a visit is pending at the start, and
// again whenever a change touches it or a neighbor.
class SearchRoute {
 public:
  // `layer` must outlive the search route. Yields to others through `budget`, which may be null.
  // REQUIRES: `route` is a valid route of `layer`.
  SearchRoute(const LayerView& layer, const Route& route, Budget* budget = nullptr);

  const LayerView& layer() const { return *layer_; }
  int size() const { return static_cast<int>(entries_.size()); }

  // The entry (of the layer's table) of the visit at `position`.
  int entry(int position) const { return entries_[static_cast<size_t>(position)]; }

  // The ends of the moves to and from the visit at `position`: where the head comes from and where
  // it goes, which is nowhere after the last visit of a problem without a finish.
  Point from(int position) const {
    return position > 0 ? layer_->table.exit(entry(position - 1)) : layer_->problem.start;
  }
  std::optional<Point> to(int position) const {
    if (position + 1 == size()) return layer_->problem.finish;
    return layer_->table.enter(entry(position + 1));
  }

  // Enters the path at `position` at another of its entries.
  void SetEntry(int position, int entry);

  int begin(int node) const { return begin_[static_cast<size_t>(node)]; }
  absl::Span<const int> order(int node) const {
    const size_t first = static_cast<size_t>(layer_->tree.first_child(node));
    return absl::MakeConstSpan(order_).subspan(first, layer_->tree.children(node).size());
  }

  // Puts the children of an any_order node into another order: slots[k] is the k-th, and if
  // reversed[k], everything below it runs backwards. O(nodes below). REQUIRES: `slots` keeps the
  // node's precedence; children that are reversed are reversible.
  void Arrange(int node, absl::Span<const int> slots, absl::Span<const char> reversed);

  // Whether the node, or the visit of `path`, is pending. Clears that.
  bool TakePendingNode(int node) { return Take(pending_node_, node); }
  bool TakePendingVisit(int path) { return Take(pending_visit_, path); }

  Route ToRoute() const;

  // Computed again, in the unit of the problem's cost, including the move to `finish`.
  double Cost() const;

 private:
#ifndef NDEBUG
  bool MayArrange(int node, absl::Span<const int> slots, absl::Span<const char> reversed) const;
#endif

  static bool Take(std::vector<char>& pending, int index) {
    char& flag = pending[static_cast<size_t>(index)];
    const bool was = flag != 0;
    flag = 0;
    return was;
  }

  int Backwards(int entry) const;
  void SortChildren(int node, Rest& rest);
  void Place(int node, int begin, bool reversed);
  void Touch(int position);

  const LayerView* layer_;
  std::vector<int> entries_;         // [position]
  std::vector<int> begin_;           // [node]
  std::vector<int> order_;           // slots of all nodes, laid out like PlanTree::first_child
  std::vector<char> pending_node_;   // [node]
  std::vector<char> pending_visit_;  // [path]
  std::vector<int> scratch_;         // entries before Arrange
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_SEARCH_ROUTE_H_
