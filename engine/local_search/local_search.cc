#include "engine/local_search/local_search.h"

#include <algorithm>
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
      queue_(static_cast<size_t>(state.tree().path_count())),
      queued_(queue_.size()) {
  touched_.reserve(static_cast<size_t>(6 * options.depth));
}

void LocalSearch::Push(int leaf) {
  if (leaf >= state_.tree().path_count() || queued_[static_cast<size_t>(leaf)]) return;
  queued_[static_cast<size_t>(leaf)] = true;
  const size_t tail = head_ + size_++;
  queue_[tail < queue_.size() ? tail : tail - queue_.size()] = leaf;
}

void LocalSearch::PushAll() {
  for (int i = 1; i < state_.last_position(); ++i) Push(state_.leaf_at(i));
}

int LocalSearch::Pop() {
  const int leaf = queue_[head_];
  if (++head_ == queue_.size()) head_ = 0;
  --size_;
  queued_[static_cast<size_t>(leaf)] = false;
  return leaf;
}

double LocalSearch::Run(Budget& budget) {
  double delta = 0;
  while (size_ > 0 && !budget.Exhausted()) {
    const int leaf = Pop();
    for (double gain = -1; gain < 0;) {
      gain = Improve(leaf);
      delta += gain;
    }
  }
  while (size_ > 0) Pop();
  return delta;
}

double LocalSearch::Improve(int leaf) {
  if (const double delta = ChooseEntry(state_.position(leaf)); delta < 0) return delta;
  if (const double delta = ImproveEdge(leaf, true); delta < 0) return delta;
  if (const double delta = ImproveEdge(leaf, false); delta < 0) return delta;
  // The ends of the route are in no queue.
  if (state_.position(leaf) == 1) {
    if (const double delta = ImproveEdge(state_.tree().start(), true); delta < 0) return delta;
  }
  if (state_.position(leaf) + 1 == state_.last_position()) {
    return ImproveEdge(state_.tree().finish(), false);
  }
  return 0;
}

double LocalSearch::ImproveEdge(int t1, bool forward) {
  const size_t mark = state_.Mark();
  double debt = 0;
  touched_.clear();
  for (int step = 0; step < options_.depth; ++step) {
    three_opt_.Search(t1, forward, debt);
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
    const double delta = debt + evaluator_.Evaluate(found.move);
    if (delta >= -kImprovementTolerance) continue;
    return delta + Do(found.move);
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
  for (int i = first; i <= last; ++i) Push(state_.leaf_at(i));
  for (int i = first; i < last; ++i) delta += ChoosePair(i);
  return delta;
}

double LocalSearch::ChooseEntry(int position) {
  const int leaf = state_.leaf_at(position);
  const LeafEntries& entries = state_.entries();
  if (entries.count(leaf) == 1) return 0;
  const int before = state_.leaf_at(position - 1);
  const int after = state_.leaf_at(position + 1);
  const bool open_end = after == state_.tree().finish() && !state_.has_finish();
  const Point to = state_.in(after);
  const int best = entries.Best(leaf, state_.out(before), open_end ? nullptr : &to, state_.cost());
  if (best == state_.entry(leaf)) return 0;
  const double old_cost = state_.StepCost(position - 1) + state_.StepCost(position);
  const double new_cost = state_.cost()(state_.out(before), entries.enter(best)) +
                          state_.MoveCost(entries.exit(best), after, to);
  if (new_cost >= old_cost - kImprovementTolerance) return 0;
  state_.SetEntry(leaf, best);
  Push(before);
  Push(leaf);
  Push(after);
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
  const TravelCost& cost = state_.cost();
  const int after = state_.leaf_at(position + 2);
  const Point from = state_.out(state_.leaf_at(position - 1));
  const Point to = state_.in(after);
  const bool open_end = after == state_.tree().finish() && !state_.has_finish();
  // Over a contour there is no shorter way than the straight one. Over an open path, whose own
  // length is free, there is, and by several moves without a retraction a quicker one.
  const bool detours_cost = !entries.open(b) && cost.is_length() && !open_end;
  if (!entries.open(b)) entries.FillTails(b, open_end ? nullptr : &to, tails_);
  const double old_cost =
      state_.StepCost(position - 1) + state_.StepCost(position) + state_.StepCost(position + 1);
  double least = old_cost - kImprovementTolerance;
  int best_a = -1;
  int best_b = -1;
  for (int i = entries.first(a); i < entries.first(a) + entries.count(a); ++i) {
    const Point out = entries.exit(i);
    const double reached = cost(from, entries.enter(i));
    const double straight = detours_cost ? Distance(out, to) : 0;
    if (reached + straight >= least) continue;
    const int j = entries.open(b) ? entries.Best(b, out, open_end ? nullptr : &to, cost)
                                  : entries.BestWithTails(b, out, tails_);
    const double total =
        reached + cost(out, entries.enter(j)) + state_.MoveCost(entries.exit(j), after, to);
    if (total >= least) continue;
    least = total;
    best_a = i;
    best_b = j;
  }
  if (best_a < 0) return 0;
  state_.SetEntry(a, best_a);
  state_.SetEntry(b, best_b);
  Push(state_.leaf_at(position - 1));
  Push(after);
  return least - old_cost;
}

}  // namespace traverse
