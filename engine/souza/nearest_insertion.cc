#include "engine/souza/nearest_insertion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/rest.h"
#include "engine/cost/first_entries.h"
#include "engine/cost/two_moves.h"
#include "engine/geometry/bounding_box.h"

namespace traverse {
namespace {

// The distance of a child that begins with an any_order node is that of this many of its points at
// most. All points would take memory again at each level of nested nodes.
constexpr size_t kFirstPoints = 64;

// More than the relative rounding error of a bound on the cost of two moves.
constexpr double kSlackOfBounds = 1e-6;

// The steps of Rest that one query for a move around walls counts for.
constexpr size_t kStepsOfMoveAmongWalls = 256;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The entries of the paths below one node, in the order in which they are visited.
using Entries = std::vector<int>;

Entries Build(const LayerView& layer, int node, Point from, const std::optional<Point>& to,
              Budget& budget);

// A passage through a child that is not in the route yet: an entry of a leaf, or a point at which a
// child with paths of its own may begin, which stands for its end too.
struct Passage {
  Point enter;
  Point exit;
  int entry;
};

// Builds the route of one any_order node.
class NodeRoute {
 public:
  NodeRoute(const LayerView& layer, int node, Point from, const std::optional<Point>& to,
            Budget& budget)
      : layer_(layer),
        children_(layer.tree.children(node)),
        precedence_(layer.tree.precedence(node)),
        from_(from),
        to_(to),
        budget_(budget),
        rest_(&budget),
        nearest_(children_.size(), kInfinity),
        boxes_(children_.size()),
        built_(children_.size()),
        position_(children_.size()),
        move_{Move(from, to)},
        awaited_(static_cast<size_t>(precedence_.item_count()), -1) {
    ListPassages();
  }

  // Incomplete if the budget ran out.
  Entries Run() {
    if (budget_.was_exhausted()) return {};
    const auto open = [&](int slot) { open_.push_back(slot); };
    ReadySlots ready(precedence_, static_cast<int>(children_.size()), open);
    Approach(from_);
    if (to_) Approach(*to_);
    while (!open_.empty() && !budget_.Exhausted()) {
      const int slot = TakeNearest();
      if (!Insert(slot)) break;
      ready.Finish(slot, open, [&](int first, int second) { Await(first, second); });
    }
    Entries entries;
    for (const int slot : order_) {
      const Entries& part = built_[static_cast<size_t>(slot)];
      entries.insert(entries.end(), part.begin(), part.end());
    }
    return entries;
  }

 private:
  // A position in the route: after `index` blocks.
  struct Insertion {
    size_t index = 0;
    int passage = -1;
    double cost = kInfinity;
  };

  // A child that is not in the route, with what Approach looks at.
  struct Waiting {
    BoundingBox box;
    double nearest = 0;  // as in nearest_
    int slot = 0;
  };

  // Those of the children inserted so far if the budget ran out.
  void ListPassages() {
    for (size_t s = 0; s < children_.size(); ++s) {
      if (!rest_(8)) return;
      first_passage_.push_back(static_cast<int>(passages_.size()));
      const bool is_leaf = layer_.tree.is_leaf(children_[s]);
      ForEachFirstEntry(layer_, children_[s], kFirstPoints, [&](int e) {
        const Point enter = layer_.table.enter(e);
        passages_.push_back(Passage{enter, is_leaf ? layer_.table.exit(e) : enter, e});
        boxes_[s].Add(passages_.back().enter);
        boxes_[s].Add(passages_.back().exit);
        rest_(4);
      });
      waiting_at_.push_back(waiting_.size());
      waiting_.push_back({boxes_[s], kInfinity, static_cast<int>(s)});
    }
    first_passage_.push_back(static_cast<int>(passages_.size()));
  }

  absl::Span<const Passage> PassagesOf(int slot) const {
    const size_t begin = static_cast<size_t>(first_passage_[static_cast<size_t>(slot)]);
    const size_t end = static_cast<size_t>(first_passage_[static_cast<size_t>(slot) + 1]);
    return absl::MakeConstSpan(passages_).subspan(begin, end - begin);
  }

  // Calls `f` with the number of each passage of `slot`, until the budget runs out.
  template <typename F>
  void ForEachPassage(int slot, F&& f) {
    constexpr size_t kAtOnce = 1 << 12;
    const size_t count = PassagesOf(slot).size();
    for (size_t begin = 0; begin < count; begin += kAtOnce) {
      const size_t end = std::min(count, begin + kAtOnce);
      if (!rest_(2 * (end - begin))) return;
      for (size_t w = begin; w < end; ++w) f(w);
    }
  }

  // Updates the distances of the children that are not in the route: it has a point at `p` now.
  void Approach(Point p) {
    for (Waiting& waiting : waiting_) {
      if (waiting.box.SquaredDistanceTo(p) >= waiting.nearest * waiting.nearest) continue;
      double& nearest = nearest_[static_cast<size_t>(waiting.slot)];
      const absl::Span<const Passage> passages = PassagesOf(waiting.slot);
      ForEachPassage(waiting.slot, [&](size_t w) {
        nearest =
            std::min({nearest, Distance(p, passages[w].enter), Distance(p, passages[w].exit)});
      });
      waiting.nearest = nearest;
    }
  }

  // `slot` is in the route now.
  void StopWaiting(int slot) {
    const size_t at = waiting_at_[static_cast<size_t>(slot)];
    waiting_[at] = waiting_.back();
    waiting_at_[static_cast<size_t>(waiting_[at].slot)] = at;
    waiting_.pop_back();
  }

  // Removes from open_ the slot nearest to the route, the lowest of several, and returns it.
  int TakeNearest() {
    size_t next = 0;
    for (size_t i = 1; i < open_.size(); ++i) {
      const double distance = nearest_[static_cast<size_t>(open_[i])];
      const double least = nearest_[static_cast<size_t>(open_[next])];
      if (distance < least || (distance == least && open_[i] < open_[next])) next = i;
    }
    std::swap(open_[next], open_.back());
    const int slot = open_.back();
    open_.pop_back();
    return slot;
  }

  // False if the budget ran out.
  bool Insert(int slot) {
    const Insertion found = BestInsertion(slot);
    if (budget_.was_exhausted()) return false;
    assert(found.passage >= 0);
    const Point from = ExitBefore(found.index);
    const std::optional<Point> to = EnterAt(found.index);
    const int child = children_[static_cast<size_t>(slot)];
    Entries& entries = built_[static_cast<size_t>(slot)];
    if (layer_.tree.is_leaf(child)) {
      entries = {passages_[static_cast<size_t>(found.passage)].entry};
    } else {
      entries = Build(layer_, child, from, to, budget_);
      if (budget_.was_exhausted()) return false;
    }
    StopWaiting(slot);
    const auto at = static_cast<std::ptrdiff_t>(found.index);
    const Point enter = layer_.table.enter(entries.front());
    const Point exit = layer_.table.exit(entries.back());
    order_.insert(order_.begin() + at, slot);
    enter_.insert(enter_.begin() + at, enter);
    exit_.insert(exit_.begin() + at, exit);
    for (size_t k = found.index; k < order_.size(); ++k) {
      position_[static_cast<size_t>(order_[k])] = k;
    }
    move_[found.index] = Move(exit, to);
    move_.insert(move_.begin() + at, layer_.cost(from, enter));
    Approach(enter);
    if (!(exit == enter)) Approach(exit);
    return true;
  }

  Point ExitBefore(size_t index) const { return index > 0 ? exit_[index - 1] : from_; }
  std::optional<Point> EnterAt(size_t index) const {
    return index < order_.size() ? enter_[index] : to_;
  }

  Insertion BestInsertion(int slot) {
    const size_t first = precedence_.empty() ? 0 : BehindSlot(awaited_[static_cast<size_t>(slot)]);
    Insertion best;
    if (layer_.cost.has_walls()) return BestInsertionAmongWalls(slot, first);
    for (size_t index = first; index <= order_.size(); ++index) {
      if (BoundOf(slot, index, best.cost) >= best.cost) continue;
      Try(slot, index, best, [&](const TwoMoves& moves) { return moves.Least(layer_.cost); });
    }
    return best;
  }

  // Tries first the places that would cost least without walls, so that few others need to be
  // tried.
  Insertion BestInsertionAmongWalls(int slot, size_t first) {
    Insertion best;
    best.cost = LimitAmongWalls(slot, first);
    by_bound_.clear();
    for (size_t index = first; index <= order_.size(); ++index) {
      const double bound = BoundOf(slot, index, best.cost);
      if (bound < best.cost) by_bound_.emplace_back(bound, index);
    }
    std::sort(by_bound_.begin(), by_bound_.end());
    for (const auto& [bound, index] : by_bound_) {
      if (bound > best.cost + kSlackOfBounds * (1 + std::abs(best.cost))) break;
      const double present = move_[index];
      Try(slot, index, best, [&](const TwoMoves& moves) {
        return moves.CostWithin(best.cost + present, layer_.cost,
                                [this] { rest_(kStepsOfMoveAmongWalls); });
      });
    }
    return best;
  }

  // A little more than the cost of the place that would be best without walls. Places whose bound
  // is above it need not be tried.
  double LimitAmongWalls(int slot, size_t first) {
    Insertion best;
    for (size_t index = first; index <= order_.size(); ++index) {
      if (BoundOf(slot, index, best.cost) >= best.cost) continue;
      Try(slot, index, best, [&](const TwoMoves& moves) { return moves.Least(layer_.cost); });
    }
    if (best.passage < 0) return kInfinity;
    const Passage& passage = passages_[static_cast<size_t>(best.passage)];
    const double cost = layer_.cost(ExitBefore(best.index), passage.enter) +
                        Move(passage.exit, EnterAt(best.index));
    return cost - move_[best.index] + kSlackOfBounds * (1 + cost);
  }

  // The first place after a block of the route; for -1 the very first.
  size_t BehindSlot(int slot) const {
    return slot < 0 ? 0 : position_[static_cast<size_t>(slot)] + 1;
  }

  // The item `second` has to come after `first`, or after those that `first` waited for if it has
  // no paths. Two blocks of the route never change their order, so the later one stands for both.
  void Await(int first, int second) {
    const bool has_paths = first < static_cast<int>(children_.size());
    const int slot = has_paths ? first : awaited_[static_cast<size_t>(first)];
    int& latest = awaited_[static_cast<size_t>(second)];
    if (BehindSlot(slot) > BehindSlot(latest)) latest = slot;
  }

  // A lower bound of the cost of any passage of `slot` at the place `index`. Stops early, with a
  // value not below `most`, if one side alone shows that.
  double BoundOf(int slot, size_t index, double most) const {
    const Point from = ExitBefore(index);
    const BoundingBox& box = boxes_[static_cast<size_t>(slot)];
    const double present = move_[index];
    // Most places are too far away on one side alone. By rounding, a move as long as the threshold
    // of retractions seems longer than what it costs allows.
    const double reach = (1 + kSlackOfBounds) * layer_.cost.LongestWithin(most + present);
    if (box.SquaredDistanceTo(from) > reach * reach) return kInfinity;
    const double bound = layer_.cost.OfLength(box.DistanceTo(from)) - present;
    const std::optional<Point> to = EnterAt(index);
    return to ? bound + layer_.cost.OfLength(box.DistanceTo(*to)) : bound;
  }

  // Replaces `best` if some passage of `slot` at the place `index` costs less, by cost_of(its two
  // moves), or as much at an earlier place.
  template <typename CostOf>
  void Try(int slot, size_t index, Insertion& best, CostOf cost_of) {
    const Point from = ExitBefore(index);
    const std::optional<Point> to = EnterAt(index);
    const absl::Span<const Passage> passages = PassagesOf(slot);
    ForEachPassage(slot, [&](size_t w) {
      const double cost =
          cost_of(TwoMoves{from, passages[w].enter, passages[w].exit, to}) - move_[index];
      if (cost > best.cost || (cost == best.cost && !(index < best.index))) return;
      best =
          Insertion{index, first_passage_[static_cast<size_t>(slot)] + static_cast<int>(w), cost};
    });
  }

  double Move(Point from, const std::optional<Point>& to) const {
    return to ? layer_.cost(from, *to) : 0;
  }

  const LayerView& layer_;
  const absl::Span<const int> children_;
  const Precedence& precedence_;
  const Point from_;
  const std::optional<Point> to_;
  Budget& budget_;
  Rest rest_;

  std::vector<Passage> passages_;
  std::vector<int> first_passage_;  // [slot] where its passages begin in passages_; one more
  std::vector<double> nearest_;     // [slot] distance in mm of its points to the route's
  std::vector<BoundingBox> boxes_;  // [slot] of its passages
  std::vector<Waiting> waiting_;    // in any order
  std::vector<size_t> waiting_at_;  // [slot] its index in waiting_, if it is there
  std::vector<Entries> built_;      // [slot] empty until it is in the route
  std::vector<int> open_;           // slots that may be inserted

  // The route: slots, and where each is entered and left.
  std::vector<int> order_;
  std::vector<size_t> position_;  // [slot] its index in order_, if it is in the route
  std::vector<Point> enter_;
  std::vector<Point> exit_;
  std::vector<double> move_;  // cost of the move to each; one more, of the move to to_

  std::vector<std::pair<double, size_t>> by_bound_;  // places for one slot

  // [item of the precedence] the last slot in the route that must come before it; -1 if none
  std::vector<int> awaited_;
};

Entries BuildLeaf(const LayerView& layer, int path, Point from, const std::optional<Point>& to) {
  int best = layer.table.first(path);
  double least = kInfinity;
  for (int e = layer.table.first(path); e < layer.table.first(path + 1); ++e) {
    double cost = layer.cost(from, layer.table.enter(e));
    if (to) cost += layer.cost(layer.table.exit(e), *to);
    if (cost >= least) continue;
    least = cost;
    best = e;
  }
  return {best};
}

// Incomplete if the budget ran out. REQUIRES: there are paths below `node`.
Entries Build(const LayerView& layer, int node, Point from, const std::optional<Point>& to,
              Budget& budget) {
  if (layer.tree.is_leaf(node)) return BuildLeaf(layer, layer.tree.node(node).path, from, to);
  if (layer.tree.node(node).kind == PlanNode::Kind::kAnyOrder) {
    return NodeRoute(layer, node, from, to, budget).Run();
  }
  const absl::Span<const int> children = layer.tree.children(node);
  Entries entries;
  for (const int child : children) {
    const bool is_last = child == children.back();
    const Entries part = Build(layer, child, from, is_last ? to : std::nullopt, budget);
    if (budget.was_exhausted()) break;
    entries.insert(entries.end(), part.begin(), part.end());
    from = layer.table.exit(entries.back());
  }
  return entries;
}

}  // namespace

std::optional<Route> NearestInsertionRoute(const LayerView& layer, Budget& budget) {
  Route route;
  if (layer.plan().paths.empty()) return route;
  if (budget.Exhausted()) return std::nullopt;
  const Entries entries = Build(layer, 0, layer.problem.start, layer.problem.finish, budget);
  if (budget.was_exhausted()) return std::nullopt;
  route.reserve(entries.size());
  for (const int entry : entries) route.push_back(layer.table.VisitOf(entry));
  return route;
}

}  // namespace traverse
