#include "engine/souza/block_line.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/tolerances.h"
#include "engine/cost/two_moves.h"

namespace traverse {

void BlockLine::Load(Point from, const std::optional<Point>& to, const std::vector<Block>& blocks,
                     const Precedence& precedence) {
  from_ = from;
  to_ = to;
  precedence_ = &precedence;
  symmetric_ = true;
  largest_detour_ = 0;
  for (auto* points : {&enter_, &exit_, &back_enter_, &back_exit_}) points->clear();
  slots_.clear();
  reversible_.clear();
  for (const Block& block : blocks) {
    enter_.push_back(block.enter);
    exit_.push_back(block.exit);
    back_enter_.push_back(block.reversible ? block.exit : block.enter);
    back_exit_.push_back(block.reversible ? block.enter : block.exit);
    slots_.push_back(block.slot);
    reversible_.push_back(block.reversible ? 1 : 0);
    symmetric_ = symmetric_ && block.reversible;
  }
  reversed_.assign(blocks.size(), 0);
  move_.assign(blocks.size() + 1, 0);
  detour_.assign(blocks.size(), 0);
  last_before_.assign(blocks.size(), -1);
  UpdateMoves(0, size());
  UpdateDetours(1);
  UpdateLastBefore();
}

// Cost of the move from `exit` to the block at `position`, or to `to` after the last block.
double BlockLine::MoveAfter(Point exit, int position) const {
  if (position < size()) return cost_(exit, enter_[static_cast<size_t>(position)]);
  return to_ ? cost_(exit, *to_) : 0;
}

void BlockLine::UpdateMoves(int first, int last) {
  for (int position = first; position <= last; ++position) {
    move_[static_cast<size_t>(position)] = MoveAfter(LeftBefore(position), position);
  }
}

void BlockLine::UpdateDetours(int first) {
  if (symmetric_) return;
  for (size_t k = static_cast<size_t>(std::max(first, 1)); k < enter_.size(); ++k) {
    detour_[k] = detour_[k - 1] + cost_(back_exit_[k], back_enter_[k - 1]) - move_[k];
    largest_detour_ = std::max(largest_detour_, std::abs(detour_[k]));
  }
}

void BlockLine::UpdateLastBefore() {
  if (precedence_->empty()) return;
  position_of_.resize(slots_.size());
  for (size_t k = 0; k < slots_.size(); ++k) {
    position_of_[static_cast<size_t>(slots_[k])] = static_cast<int>(k);
  }
  precedence_->LastBefore(position_of_, last_of_);
  for (size_t k = 0; k < slots_.size(); ++k) {
    last_before_[k] = last_of_[static_cast<size_t>(slots_[k])];
  }
}

double BlockLine::ReversalDelta(int first, int last) const {
  return ReversalDelta(first, last, std::numeric_limits<double>::infinity());
}

double BlockLine::ReversalDelta(int first, int last, double most) const {
  assert(0 <= first && first <= last && last < size());
  const size_t i = static_cast<size_t>(first);
  const size_t j = static_cast<size_t>(last);
  TwoMoves moves{LeftBefore(first), back_enter_[j], back_exit_[i], to_};
  if (last + 1 < size()) moves.d = enter_[j + 1];
  return moves.CostWithin(most, cost_) - move_[i] - move_[j + 1] + detour_[j] - detour_[i];
}

BlockLine::Reversal BlockLine::BestReversalFrom(int first, double delta) const {
  assert(0 <= first && first < size() && delta <= 0);
  const size_t i = static_cast<size_t>(first);
  const Point from = LeftBefore(first);
  const double gone = move_[i] + detour_[i];
  Reversal best{-1, delta};
  for (size_t j = i; j < enter_.size(); ++j) {
    // A block that waits for one of [first, j] cannot come before it; longer stretches fail too.
    if (j > i && last_before_[j] >= first) break;
    // The two new moves together must cost less than `limit`, so the first one alone must: most
    // pairs end here, without a square root.
    const double limit = gone + move_[j + 1] - detour_[j] + best.delta;
    if (limit <= 0) continue;
    const double reach = cost_.LongestWithin(limit);
    const double dx = back_enter_[j].x - from.x;
    const double dy = back_enter_[j].y - from.y;
    if (dx * dx + dy * dy > reach * reach) continue;
    const int last = static_cast<int>(j);
    if (const double change = ReversalDelta(first, last, limit); change < best.delta)
      best = {last, change};
  }
  return best;
}

void BlockLine::Reverse(int first, int last) {
  assert(0 <= first && first <= last && last < size());
  assert(std::all_of(last_before_.begin() + first, last_before_.begin() + last + 1,
                     [first](int before) { return before < first; }));
  const auto reverse = [&](auto& values) {
    std::reverse(values.begin() + first, values.begin() + last + 1);
  };
  for (auto* points : {&enter_, &exit_, &back_enter_, &back_exit_}) reverse(*points);
  for (auto* flags : {&reversed_, &reversible_}) reverse(*flags);
  reverse(slots_);
  for (size_t k = static_cast<size_t>(first); k <= static_cast<size_t>(last); ++k) {
    if (!reversible_[k]) continue;
    std::swap(enter_[k], back_enter_[k]);
    std::swap(exit_[k], back_exit_[k]);
    reversed_[k] ^= 1;
  }
  UpdateMoves(first, last + 1);
  UpdateDetours(first);
  UpdateLastBefore();
}

double BlockLine::tolerance() const {
  const double noise = std::numeric_limits<double>::epsilon() * size() * largest_detour_;
  return std::max(kImprovementTolerance, noise);
}

double BlockLine::Cost() const {
  double sum = 0;
  for (int position = 0; position <= size(); ++position) {
    sum += MoveAfter(LeftBefore(position), position);
  }
  return sum;
}

}  // namespace traverse
