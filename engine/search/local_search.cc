#include "engine/search/local_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/tolerances.h"

namespace traverse {
namespace {

// More pairs of entries than this are not tried one by one.
constexpr int kMostPairs = 1 << 15;

}  // namespace

LocalSearch::LocalSearch(SearchState& state, const NeighborLists& neighbors,
                         const LocalSearchOptions& options)
    : state_(state),
      options_(options),
      three_opt_(state, neighbors, options.three_opt),
      evaluator_(state),
      queue_(state.tree().path_count(), state.tree().leaf_count()) {
  touched_.reserve(static_cast<size_t>(6 * options.depth));
}

void LocalSearch::PushAll() {
  for (int i = 1; i < state_.last_position(); ++i) Push(state_.leaf_at(i));
}

double LocalSearch::Run(Budget& budget, double owed) {
  double delta = 0;
  const auto ends = [&] {
    return (delta < 0 && std::abs(delta + owed) <= kImprovementTolerance) || budget.Exhausted();
  };
  while (!queue_.empty() && !ends()) {
    const int leaf = queue_.Pop();
    for (double gain = -1; gain < 0 && !ends();) {
      gain = Improve(leaf);
      delta += gain;
    }
    queue_.Forget(leaf);
  }
  queue_.Clear();
  return delta;
}

double LocalSearch::Improve(int leaf) {
  const int at = state_.position(leaf);
  if (const double delta = ChooseEntry(at); delta < 0) return delta;
  if (options_.both_edges || queue_.Changed(leaf, state_.leaf_at(at + 1))) {
    if (const double delta = ImproveEdge(leaf, true); delta < 0) return delta;
  }
  if (options_.both_edges || queue_.Changed(leaf, state_.leaf_at(at - 1))) {
    if (const double delta = ImproveEdge(leaf, false); delta < 0) return delta;
  }
  // The ends of the route are in no queue.
  if (at == 1) {
    if (const double delta = ImproveEdge(state_.tree().start(), true); delta < 0) return delta;
  }
  if (at + 1 == state_.last_position()) {
    return ImproveEdge(state_.tree().finish(), false);
  }
  return 0;
}

double LocalSearch::ImproveEdge(int t1, bool forward) {
  const size_t mark = state_.Mark();
  double debt = 0;
  touched_.clear();
  for (int step = 0; step < options_.depth; ++step) {
    three_opt_.Search(t1, forward, debt, step + 1 < options_.depth);
    if (const double delta = TryFound(debt); delta < 0) {
      for (const int leaf : touched_) Push(leaf);
      return delta;
    }
    const ThreeOpt::Open& open = three_opt_.open();
    if (open.t2 < 0 || open.t2 >= state_.tree().path_count()) break;
    if (step + 1 == options_.depth) break;
    ApplyTrial(open.move);
    debt = open.delta;
    forward = state_.position(open.t2) > state_.position(t1);
  }
  state_.UndoTo(mark);
  return 0;
}

// Does the first move found that makes the route cheaper than it was without the `debt`.
double LocalSearch::TryFound(double debt) {
  for (const ThreeOpt::Found& found : three_opt_.found()) {
    if (rejected_.Contains(found.move, state_.route_number())) continue;
    const double most = -debt - kImprovementTolerance;
    const double delta = evaluator_.Evaluate(found.move, most);
    if (delta < most) return debt + delta + Do(found.move);
    rejected_.Add(found.move, state_.route_number());
  }
  return 0;
}

// Does the move evaluated last; returns what choosing the entries exactly adds to its gain.
double LocalSearch::Do(const SegmentMove& move) {
  evaluator_.Apply(move);
  double delta = ChooseEntries(move.first - 1, move.first);
  if (move.segment_count() == 2) {
    delta += ChooseEntries(move.NewMiddle() - 1, move.NewMiddle());
  }
  return delta + ChooseEntries(move.last, move.last + 1);
}

void LocalSearch::ApplyTrial(const SegmentMove& move) {
  for (const int position :
       {move.first - 1, move.first, move.middle - 1, move.middle, move.last, move.last + 1}) {
    touched_.push_back(state_.leaf_at(position));
  }
  state_.Apply(move);
}

double LocalSearch::ChooseEntries(int first, int last) {
  double delta = 0;
  for (int i = first; i < last; ++i) PushMove(i);
  for (int i = first; i < last; ++i) delta += ChoosePair(i);
  return delta;
}

double LocalSearch::ChooseEntry(int position) {
  const int leaf = state_.leaf_at(position);
  const LeafEntries& entries = state_.entries();
  if (entries.count(leaf) == 1) return 0;
  const int before = state_.leaf_at(position - 1);
  const int after = state_.leaf_at(position + 1);
  const bool open_end = state_.IsFree(after);
  const Point to = state_.in(after);
  const int best = entries.Best(leaf, state_.out(before), open_end ? nullptr : &to, state_.cost());
  if (best == state_.entry(leaf)) return 0;
  const double old_cost = state_.StepCost(position - 1) + state_.StepCost(position);
  const double new_cost = state_.cost()(state_.out(before), entries.enter(best)) +
                          state_.MoveCost(entries.exit(best), after, to);
  if (new_cost >= old_cost - kImprovementTolerance) return 0;
  state_.SetEntry(leaf, best);
  PushMove(position - 1);
  PushMove(position);
  return new_cost - old_cost;
}

// The best entries of two visits between their neighbors.
double LocalSearch::ChoosePair(int position) {
  const LeafEntries& entries = state_.entries();
  const int a = state_.leaf_at(position);
  const int b = state_.leaf_at(position + 1);
  const bool a_fixed = position == 0 || entries.count(a) == 1;
  const bool b_fixed = position + 1 == state_.last_position() || entries.count(b) == 1;
  if (a_fixed && b_fixed) return 0;
  if (a_fixed) return ChooseEntry(position + 1);
  if (b_fixed) return ChooseEntry(position);
  if (entries.count(a) * entries.count(b) > kMostPairs) {
    const double delta = ChooseEntry(position) + ChooseEntry(position + 1);
    return delta + ChooseEntry(position);
  }
  const double old_cost =
      state_.StepCost(position - 1) + state_.StepCost(position) + state_.StepCost(position + 1);
  Pair best{-1, -1, old_cost - kImprovementTolerance};
  if (entries.open(a)) {
    for (int i = entries.first(a); i < entries.first(a) + entries.count(a); ++i) {
      TryPair(position, i, BestAfter(position, entries.exit(i)), best);
    }
  } else if (entries.open(b)) {
    const Point from = state_.out(state_.leaf_at(position - 1));
    for (int j = entries.first(b); j < entries.first(b) + entries.count(b); ++j) {
      const Point enter = entries.enter(j);
      TryPair(position, entries.Best(a, from, &enter, state_.cost()), j, best);
    }
  } else {
    ChooseContours(position, best);
  }
  if (best.a < 0) return 0;
  state_.SetEntry(a, best.a);
  state_.SetEntry(b, best.b);
  for (int i = position - 1; i <= position + 1; ++i) PushMove(i);
  return best.cost - old_cost;
}

// The cheapest entry for the visit after `position`, reached from `from`.
int LocalSearch::BestAfter(int position, Point from) const {
  const int after = state_.leaf_at(position + 2);
  const Point to = state_.in(after);
  const bool open_end = state_.IsFree(after);
  return state_.entries().Best(state_.leaf_at(position + 1), from, open_end ? nullptr : &to,
                               state_.cost());
}

void LocalSearch::TryPair(int position, int a, int b, Pair& best) const {
  const LeafEntries& entries = state_.entries();
  const int after = state_.leaf_at(position + 2);
  const double total = state_.cost()(state_.out(state_.leaf_at(position - 1)), entries.enter(a)) +
                       state_.cost()(entries.exit(a), entries.enter(b)) +
                       state_.MoveCost(entries.exit(b), after, state_.in(after));
  if (total < best.cost) best = Pair{a, b, total};
}

// All entries of the first contour that bounds do not rule out, each with the best of the second.
void LocalSearch::ChooseContours(int position, Pair& best) {
  const LeafEntries& entries = state_.entries();
  const int a = state_.leaf_at(position);
  const int b = state_.leaf_at(position + 1);
  const int after = state_.leaf_at(position + 2);
  const Point to = state_.in(after);
  const bool open_end = state_.IsFree(after);
  entries.FillTails(b, open_end ? nullptr : &to, tails_);
  entries.FillPairBounds(a, b, state_.out(state_.leaf_at(position - 1)), open_end ? nullptr : &to,
                         tails_, bounds_);
  for (int i = 0; i < entries.count(a); ++i) {
    if (static_cast<double>(bounds_[static_cast<size_t>(i)]) >= best.cost) continue;
    const int entry = entries.first(a) + i;
    TryPair(position, entry, entries.BestWithTails(b, entries.exit(entry), tails_), best);
  }
}

}  // namespace traverse
