// A route under local search: order and entries with positions; every change can be undone.

#ifndef TRAVERSE_ENGINE_SEARCH_SEARCH_STATE_H_
#define TRAVERSE_ENGINE_SEARCH_SEARCH_STATE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/budget.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/search/entries/leaf_entries.h"
#include "engine/search/order_tree.h"
#include "engine/search/segment_move.h"

namespace traverse {

// An array of leaves with the position of each; the start is at position 0, the finish at
// last_position(). Changes are logged, so a trial costs only what it touches and not a copy of the
// route. Memory: about 90 bytes per path.
class SearchState {
 public:
  // The arguments must outlive the state; of `problem`, everything but its plan.
  SearchState(const LayerProblem& problem, const OrderTree& tree, const LeafEntries& entries);

  // Load from a valid route of the problem, and unload to one. Loading clears the log, and asks
  // `budget` regularly, if it is not null.
  void Load(const Route& route, Budget* budget = nullptr);
  Route Unload() const;
  void Unload(Route& route) const;  // the same; allocates nothing if the route has room

  const OrderTree& tree() const { return tree_; }
  const LeafEntries& entries() const { return entries_; }
  const TravelCost& cost() const { return cost_; }

  // Whether the move to `leaf` costs nothing: a finish that may be anywhere.
  bool IsFree(int leaf) const { return leaf == tree_.finish() && !has_finish_; }

  int last_position() const { return tree_.leaf_count() - 1; }
  int leaf_at(int position) const { return order_[Index(position)]; }

  // The position of a leaf; of an inner node, that of its first leaf.
  int position(int item) const { return position_[Index(item)]; }

  int entry(int leaf) const { return entry_[Index(leaf)]; }
  Point in(int leaf) const { return in_[Index(leaf)]; }
  Point out(int leaf) const { return out_[Index(leaf)]; }

  // Cost of the move from `from`, the exit of a visit, to `to`, where `leaf` is entered.
  double MoveCost(Point from, int leaf, Point to) const {
    return IsFree(leaf) ? 0 : cost_(from, to);
  }
  // Cost of the move from position `position` to the next one.
  double StepCost(int position) const { return steps_[Index(position)]; }
  double TotalCost() const;

  // The same for inner loops, which then ask nothing on the way; they stay where they are.
  struct Arrays {
    const int* leaf;          // [position]
    const double* step_cost;  // [position]
    const int* position;      // [item]
    const Point* in;          // [leaf]
    const Point* out;         // [leaf]
  };
  Arrays arrays() const {
    return {order_.data(), steps_.data(), position_.data(), in_.data(), out_.data()};
  }

  // Whether the plan allows `move`. O(1) if the moved leaves are children of one node without
  // pairs, else up to O(leaves and pairs moved).
  bool Allows(const SegmentMove& move) const;

  // REQUIRES: the move is allowed; `entry` is one of `leaf`.
  void Apply(const SegmentMove& move);
  void SetEntry(int leaf, int entry);

  // The number of the loaded route, above 0: equal numbers of one state mean equal routes. Undoing
  // changes brings back the number from before them.
  uint64_t route_number() const { return route_number_; }

  // Undo everything since Mark() returned `mark`; forget how to undo it.
  size_t Mark() const { return log_.size(); }
  void UndoTo(size_t mark);
  void Commit() { log_.clear(); }

 private:
  struct Change {
    enum class Kind { kEntry, kReverse, kExchange } kind;
    int a, b, c;            // leaf, old entry; first, last; first, middle, last
    uint64_t route_number;  // before it
  };

  void Note(Change::Kind kind, int a, int b, int c) {
    log_.push_back({kind, a, b, c, route_number_});
    route_number_ = ++last_route_number_;
  }

  static size_t Index(int i) { return static_cast<size_t>(i); }

  bool IsUnionOfChildren(int node, int first, int last) const;
  bool AllowsReverse(int first, int last) const;
  bool CanReverseWithin(int node, int first, int last) const;
  bool AllowsExchange(int node, const SegmentMove& move) const;

  void Reverse(int first, int last);
  void DoReverse(int first, int last);
  void MeasureStep(int position);
  void DoExchange(int first, int middle, int last);
  void DoSetEntry(int leaf, int entry);
  void Enter(int leaf, int entry);
  void PlaceInnerNodes(int first, int last);
  void PlaceInnerNodesAbove(int position, int size);

  const OrderTree& tree_;
  const LeafEntries& entries_;
  const TravelCost cost_;
  const bool has_finish_;
  std::vector<int> order_;     // [position]
  std::vector<double> steps_;  // [position] cost of the move from there to the next one
  std::vector<int> position_;  // [item]
  std::vector<int> entry_;     // [leaf]
  std::vector<Point> in_;      // [leaf] where its entry begins,
  std::vector<Point> out_;     // [leaf] and ends
  std::vector<Change> log_;
  uint64_t route_number_ = 0;
  uint64_t last_route_number_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SEARCH_SEARCH_STATE_H_
