#include "engine/search/move_evaluator.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/base/tolerances.h"

namespace traverse {
namespace {

// Segments up to this size belong to one stretch as a whole.
constexpr int kShortSegment = 3;

// Rounding of two sums over a whole route, relative to its cost.
[[maybe_unused]] constexpr double kDeltaRounding = 1e-9;

}  // namespace

double MoveEvaluator::Evaluate(const SegmentMove& move, double most) {
  count_ = 0;
  begins_ = true;
  old_cost_ = state_.StepCost(move.first - 1) + state_.StepCost(move.last);
  if (move.segment_count() == 2) old_cost_ += state_.StepCost(move.middle - 1);

  if (move.first >= 2) {
    old_cost_ += state_.StepCost(move.first - 2);
    AddVisit(move.first - 2, false, false);
  }
  AddVisit(move.first - 1, false, true);
  const std::array<Segment, 2> order = move.NewOrder();
  for (int s = 0; s < move.segment_count(); ++s) AddSegment(order[static_cast<size_t>(s)]);
  AddVisit(move.last + 1, false, true);
  if (move.last + 2 <= state_.last_position()) {
    old_cost_ += state_.StepCost(move.last + 1);
    AddVisit(move.last + 2, false, false);
  }

  complete_ = true;
  const double limit = old_cost_ + most;
  double new_cost = 0;
  for (size_t i = 1; i < count_ && new_cost < limit; ++i) {
    const NearVisit& visit = visits_[i];
    if (visit.begins) continue;
    if (visit.free) Choose(i);
    new_cost += state_.MoveCost(visits_[i - 1].out, visit.leaf, visit.in);
  }
  complete_ = new_cost < limit;
  delta_ = new_cost - old_cost_;
  // At large costs the limit is subject to rounding, and the difference is smaller.
  return complete_ ? delta_ : std::max(delta_, most);
}

// The segment's ends are free. A long segment divides the stretch: its inside stays.
void MoveEvaluator::AddSegment(const Segment& segment) {
  const int size = segment.size();
  for (int i = 0; i < size; ++i) {
    if (size > kShortSegment && i == 2) {
      begins_ = true;
      i = size - 2;
    }
    const bool continues = i > 0 && !begins_;
    AddVisit(segment.At(i), segment.reversed, i == 0 || i == size - 1);
    if (!continues) continue;
    const int position = segment.reversed ? segment.At(i) : segment.At(i - 1);
    old_cost_ += state_.StepCost(position);
  }
}

void MoveEvaluator::AddVisit(int position, bool reversed, bool free) {
  assert(count_ < visits_.size());
  const int leaf = state_.leaf_at(position);
  const Point in = state_.in(leaf);
  const Point out = state_.out(leaf);
  const bool has_choice = state_.entries().count(leaf) > 1;
  visits_[count_++] =
      NearVisit{leaf, reversed ? out : in, reversed ? in : out, free && has_choice, begins_, -1};
  begins_ = false;
}

// Chooses the entry of a free visit, which has others of its stretch on both sides.
void MoveEvaluator::Choose(size_t i) {
  const LeafEntries& entries = state_.entries();
  NearVisit& visit = visits_[i];
  const NearVisit& next = visits_[i + 1];
  visit.entry = entries.Best(visit.leaf, visits_[i - 1].out,
                             state_.IsFree(next.leaf) ? nullptr : &next.in, state_.cost());
  visit.in = entries.enter(visit.entry);
  visit.out = entries.exit(visit.entry);
}

void MoveEvaluator::Apply(const SegmentMove& move) {
  assert(complete_);
#ifndef NDEBUG
  const double before = state_.TotalCost();
#endif
  state_.Apply(move);
  for (size_t i = 0; i < count_; ++i) {
    if (visits_[i].entry >= 0) state_.SetEntry(visits_[i].leaf, visits_[i].entry);
  }
  assert(std::abs(state_.TotalCost() - (before + delta_)) <=
         kCostTolerance + kDeltaRounding * before);
}

}  // namespace traverse
