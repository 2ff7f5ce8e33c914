#include "engine/search/search_state.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "engine/base/rest.h"

namespace traverse {

using Kind = SegmentMove::Kind;

SearchState::SearchState(const LayerProblem& problem, const OrderTree& tree,
                         const LeafEntries& entries)
    : tree_(tree),
      entries_(entries),
      cost_(problem),
      has_finish_(problem.finish.has_value()),
      order_(Index(tree.leaf_count())),
      steps_(order_.size()),
      position_(Index(tree.item_count())),
      entry_(order_.size()),
      in_(order_.size()),
      out_(order_.size()) {}

void SearchState::Load(const Route& route, Budget* budget) {
  size_t k = 0;
  const auto append = [&](int leaf, int entry) {
    order_[k] = leaf;
    position_[Index(leaf)] = static_cast<int>(k++);
    Enter(leaf, entry);
  };
  Rest rest(budget);
  append(tree_.start(), entries_.first(tree_.start()));
  for (const Visit& visit : route) {
    rest(8 + static_cast<size_t>(visit.entry) / 4);
    append(visit.path, entries_.EntryOf(visit));
  }
  append(tree_.finish(), entries_.first(tree_.finish()));
  for (int i = last_position(); i >= 0; --i) {
    rest(4 * static_cast<size_t>(tree_.depth(leaf_at(i))));
    PlaceInnerNodesAbove(i, tree_.leaf_count());
  }
  for (int i = 0; i < last_position(); ++i) {
    rest(8);
    MeasureStep(i);
  }
  log_.clear();
  route_number_ = ++last_route_number_;
}

Route SearchState::Unload() const {
  Route route;
  Unload(route);
  return route;
}

void SearchState::Unload(Route& route) const {
  route.clear();
  route.reserve(order_.size() - 2);
  for (int i = 1; i < last_position(); ++i) {
    route.push_back(entries_.VisitOf(leaf_at(i), entry(leaf_at(i))));
  }
}

double SearchState::TotalCost() const {
  double sum = 0;
  for (int i = 0; i < last_position(); ++i) sum += StepCost(i);
  return sum;
}

bool SearchState::Allows(const SegmentMove& move) const {
  if (move.kind == Kind::kReverse) return AllowsReverse(move.first, move.last);
  if (move.kind == Kind::kReverseBoth) {
    return AllowsReverse(move.first, move.middle - 1) && AllowsReverse(move.middle, move.last);
  }
  const int node = tree_.CommonNode(leaf_at(move.first), leaf_at(move.last));
  if (!tree_.free_order(node) || !IsUnionOfChildren(node, move.first, move.middle - 1) ||
      !IsUnionOfChildren(node, move.middle, move.last)) {
    return false;
  }
  if (move.kind == Kind::kExchangeReverseFirst &&
      !CanReverseWithin(node, move.first, move.middle - 1)) {
    return false;
  }
  if (move.kind == Kind::kExchangeReverseSecond &&
      !CanReverseWithin(node, move.middle, move.last)) {
    return false;
  }
  return !tree_.has_pairs(node) || AllowsExchange(node, move);
}

// Whether children of `node` begin at `first` and end at `last`. REQUIRES: both are below `node`.
bool SearchState::IsUnionOfChildren(int node, int first, int last) const {
  const int begin = leaf_at(first);
  if (tree_.parent(begin) != node && position(tree_.ChildHolding(node, begin)) != first) {
    return false;
  }
  const int end = leaf_at(last);
  if (tree_.parent(end) == node) return true;
  const int child = tree_.ChildHolding(node, end);
  return position(child) + tree_.size(child) - 1 == last;
}

bool SearchState::AllowsReverse(int first, int last) const {
  if (first == last) return tree_.reversible(leaf_at(first));
  const int node = tree_.CommonNode(leaf_at(first), leaf_at(last));
  return tree_.free_order(node) && IsUnionOfChildren(node, first, last) &&
         CanReverseWithin(node, first, last);
}

// REQUIRES: [first, last] is a union of children of `node`.
bool SearchState::CanReverseWithin(int node, int first, int last) const {
  if (tree_.children_reversible(node) && !tree_.has_pairs(node)) return true;
  for (int i = first; i <= last;) {
    const int child = tree_.ChildHolding(node, leaf_at(i));
    if (!tree_.reversible(child)) return false;
    for (const int later : tree_.after(child)) {
      if (position(later) <= last) return false;
    }
    i += tree_.size(child);
  }
  return true;
}

// Checks the pairs of the shorter segment.
bool SearchState::AllowsExchange(int node, const SegmentMove& move) const {
  const bool first_is_shorter = move.middle - move.first <= move.last - move.middle + 1;
  const int begin = first_is_shorter ? move.first : move.middle;
  const int end = first_is_shorter ? move.middle - 1 : move.last;
  for (int i = begin; i <= end;) {
    const int child = tree_.ChildHolding(node, leaf_at(i));
    for (const int other : first_is_shorter ? tree_.after(child) : tree_.before(child)) {
      const int place = position(other);
      if (first_is_shorter ? place >= move.middle && place <= move.last
                           : place >= move.first && place < move.middle) {
        return false;
      }
    }
    i += tree_.size(child);
  }
  return true;
}

void SearchState::Apply(const SegmentMove& move) {
  assert(Allows(move));
  if (move.kind == Kind::kReverse) {
    Reverse(move.first, move.last);
    return;
  }
  if (move.kind == Kind::kReverseBoth) {
    Reverse(move.first, move.middle - 1);
    Reverse(move.middle, move.last);
    return;
  }
  Note(Change::Kind::kExchange, move.first, move.middle, move.last);
  DoExchange(move.first, move.middle, move.last);
  const int middle = move.NewMiddle();
  if (move.kind == Kind::kExchangeReverseFirst) Reverse(middle, move.last);
  if (move.kind == Kind::kExchangeReverseSecond) Reverse(move.first, middle - 1);
}

void SearchState::SetEntry(int leaf, int new_entry) {
  assert(entries_.first(leaf) <= new_entry);
  assert(new_entry < entries_.first(leaf) + entries_.count(leaf));
  if (entry(leaf) == new_entry) return;
  Note(Change::Kind::kEntry, leaf, entry(leaf), 0);
  DoSetEntry(leaf, new_entry);
}

void SearchState::UndoTo(size_t mark) {
  while (log_.size() > mark) {
    const Change change = log_.back();
    log_.pop_back();
    route_number_ = change.route_number;
    switch (change.kind) {
      case Change::Kind::kEntry:
        DoSetEntry(change.a, change.b);
        break;
      case Change::Kind::kReverse:
        DoReverse(change.a, change.b);
        break;
      case Change::Kind::kExchange:
        DoExchange(change.a, change.a + change.c - change.b + 1, change.c);
        break;
    }
  }
}

void SearchState::Reverse(int first, int last) {
  Note(Change::Kind::kReverse, first, last, 0);
  DoReverse(first, last);
}

void SearchState::DoReverse(int first, int last) {
  std::reverse(order_.begin() + first, order_.begin() + last + 1);
  std::reverse(steps_.begin() + first, steps_.begin() + last);
  for (int i = first; i <= last; ++i) {
    const int leaf = leaf_at(i);
    position_[Index(leaf)] = i;
    if (!entries_.open(leaf)) continue;
    entry_[Index(leaf)] = entries_.Reversed(leaf, entry(leaf));
    std::swap(in_[Index(leaf)], out_[Index(leaf)]);
  }
  MeasureStep(first - 1);
  MeasureStep(last);
  if (tree_.nested()) PlaceInnerNodes(first, last);
}

void SearchState::DoExchange(int first, int middle, int last) {
  std::rotate(order_.begin() + first, order_.begin() + middle, order_.begin() + last + 1);
  std::rotate(steps_.begin() + first, steps_.begin() + middle, steps_.begin() + last + 1);
  for (int i = first; i <= last; ++i) position_[Index(leaf_at(i))] = i;
  MeasureStep(first - 1);
  MeasureStep(first + last - middle);
  MeasureStep(last);
  if (tree_.nested()) PlaceInnerNodes(first, last);
}

void SearchState::DoSetEntry(int leaf, int entry) {
  Enter(leaf, entry);
  const int at = position(leaf);
  MeasureStep(at - 1);
  MeasureStep(at);
}

void SearchState::MeasureStep(int position) {
  const int next = leaf_at(position + 1);
  steps_[Index(position)] = MoveCost(out(leaf_at(position)), next, in(next));
}

void SearchState::Enter(int leaf, int entry) {
  entry_[Index(leaf)] = entry;
  in_[Index(leaf)] = entries_.enter(entry);
  out_[Index(leaf)] = entries_.exit(entry);
}

// Notes where the nodes begin whose leaves are all in [first, last]. From the back, so that the
// first leaf of a node has the last word.
void SearchState::PlaceInnerNodes(int first, int last) {
  const int size = last - first + 1;
  for (int i = last; i >= first; --i) PlaceInnerNodesAbove(i, size);
}

// Notes a leaf's position for the nodes of up to `size` leaves that it is in.
void SearchState::PlaceInnerNodesAbove(int position, int size) {
  for (int node = tree_.parent(leaf_at(position)); node >= 0 && tree_.size(node) <= size;
       node = tree_.parent(node)) {
    position_[Index(node)] = position;
  }
}

}  // namespace traverse
