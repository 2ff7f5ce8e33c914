#include "engine/proof/walks/walk_dp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace traverse {
namespace {

// Comparing all rows of a cell with each other pays off below.
constexpr int kMostRowsForDominance = 96;

}  // namespace

template <int kWords>
WalkDp<kWords>::WalkDp(const StageModel& model, int stages)
    : model_(model), multipliers_(static_cast<size_t>(model.first(stages))) {
  for (int stage = 0; stage < stages; ++stage) assert(model.size(stage) <= Memory::kCapacity);
  for (int c = 0; c < model.first(stages); ++c) {
    remembered_.push_back(Bit(c));
    Memory& before = before_.emplace_back();
    for (const int other : model.Before(c)) before.Add(other - model.first(model.stage_of(c)));
    Memory& after = after_.emplace_back();
    for (const int other : model.After(c)) after.Add(other - model.first(model.stage_of(c)));
  }
  for (int c = model.first(stages - 1); c < model.first(stages); ++c) {
    const auto states = static_cast<size_t>(model.states(c));
    std::vector<double>& finish = finish_.emplace_back(states);
    if (stages == model.stage_count()) finish.assign(model.Finish(c), model.Finish(c) + states);
  }
  for (int s = 0; s < stages; ++s) {
    for (int i = 0; i < model.size(s); ++i) {
      stage_at_.push_back(s);
      auto& alive = alive_.emplace_back(static_cast<size_t>(model.size(s)));
      for (int c = model.first(s); c < model.first(s + 1); ++c) {
        // What comes before and after needs its positions too.
        const bool fits = static_cast<int>(model.Before(c).size()) <= i &&
                          static_cast<int>(model.After(c).size()) < model.size(s) - i;
        if (fits)
          alive[static_cast<size_t>(c - model.first(s))].assign(
              static_cast<size_t>(model.states(c)), 1);
      }
    }
  }
}

template <int kWords>
const double* WalkDp<kWords>::Finish(int cluster) const {
  return finish_[static_cast<size_t>(cluster - FirstAt(positions() - 1))].data();
}

template <int kWords>
void WalkDp<kWords>::SetMultipliers(const std::vector<double>& multipliers) {
  complete_ = {};
  multipliers_ = multipliers;
  multiplier_sum_ = std::accumulate(multipliers.begin(), multipliers.end(), 0.0);
}

template <int kWords>
void WalkDp<kWords>::SetFinish(std::vector<std::vector<double>> finish) {
  complete_ = {};
  finish_ = std::move(finish);
}

template <int kWords>
bool WalkDp<kWords>::Remembers(int cluster, int other) const {
  return remembered_[static_cast<size_t>(cluster)].Intersects(Bit(other));
}

template <int kWords>
bool WalkDp<kWords>::Remember(int cluster, int other) {
  assert(model_.stage_of(cluster) == model_.stage_of(other));
  if (Remembers(cluster, other)) return false;
  remembered_[static_cast<size_t>(cluster)].Add(other - model_.first(model_.stage_of(other)));
  return true;
}

template <int kWords>
typename WalkDp<kWords>::Outcome WalkDp<kWords>::Run(Direction direction, bool prune,
                                                     double most_cost, double most_operations,
                                                     Budget& budget) {
  const bool is_forward = direction == Direction::kForward;
  complete_[static_cast<size_t>(direction)] = false;
  Table& filled = table(direction);
  const Table& other = is_forward ? backward_ : forward_;
  filled.assign(static_cast<size_t>(positions()), {});
  operations_ = 0;
  const double most_sum = most_cost + multiplier_sum_;
  for (int step = 0; step < positions(); ++step) {
    const int position = is_forward ? step : positions() - 1 - step;
    const int previous = is_forward ? position - 1 : position + 1;
    const auto p = static_cast<size_t>(position);
    const int first = FirstAt(position);
    filled[p].resize(alive_[p].size());
    for (size_t i = 0; i < alive_[p].size(); ++i) {
      if (alive_[p][i].empty()) continue;
      if (budget.Exhausted()) return Outcome::kStopped;
      const int cluster = first + static_cast<int>(i);
      target_.Clear(model_.states(cluster));
      if (step == 0) {
        FillFirst(direction, cluster);
      } else {
        const bool new_stage = StageAt(previous) != StageAt(position);
        const std::vector<Rows>& sources = filled[static_cast<size_t>(previous)];
        for (size_t j = 0; j < sources.size(); ++j) {
          const int from = FirstAt(previous) + static_cast<int>(j);
          Extend(direction, sources[j], from, cluster, new_stage);
        }
      }
      DropDead(position, cluster);
      if (prune && !Prune(other[p][i], cluster, most_sum, budget)) return Outcome::kStopped;
      target_.rows().DropUnreached();
      DropDominated();
      filled[p][i] = target_.rows();
      if (operations_ > most_operations) return Outcome::kTooBig;
    }
  }
  complete_[static_cast<size_t>(direction)] = true;
  return Outcome::kDone;
}

template <int kWords>
void WalkDp<kWords>::FillFirst(Direction direction, int cluster) {
  double* costs = target_.CostsOf(Bit(cluster));
  const bool is_forward = direction == Direction::kForward;
  const double* given = is_forward ? model_.Start(cluster) : Finish(cluster);
  const double offset = is_forward ? multipliers_[static_cast<size_t>(cluster)] : 0;
  for (int state = 0; state < model_.states(cluster); ++state) costs[state] = given[state] + offset;
}

// Adds to the target, a cell of `to`, the walks that come from `source`, a cell of `from`.
// (Backward these are walks from `to` on to `from`.)
template <int kWords>
void WalkDp<kWords>::Extend(Direction direction, const Rows& source, int from, int to,
                            bool new_stage) {
  const bool is_forward = direction == Direction::kForward;
  if (source.empty() || !(is_forward ? model_.CanFollow(from, to) : model_.CanFollow(to, from))) {
    return;
  }
  const auto t = static_cast<size_t>(to);
  const Memory bit = Bit(to);
  const Memory& excluded = is_forward ? after_[t] : before_[t];
  // Walks that will remember the same are merged first, so that the product is done once.
  grouped_.Clear(source.states());
  for (int row = 0; row < source.size(); ++row) {
    const Memory& memory = source.memory(row);
    if (new_stage) {
      ElementwiseMin(source.costs(row), grouped_.CostsOf(bit), source.states());
    } else if (!memory.Intersects(bit) && !memory.Intersects(excluded)) {
      ElementwiseMin(source.costs(row), grouped_.CostsOf((memory & remembered_[t]) | bit),
                     source.states());
    }
  }
  const double offset = multipliers_[static_cast<size_t>(is_forward ? to : from)];
  const double* moves = is_forward ? model_.Move(from, to) : model_.MoveTransposed(to, from);
  const Rows& groups = grouped_.rows();
  for (int row = 0; row < groups.size(); ++row) {
    MinPlus(groups.costs(row), source.states(), offset, moves, target_.CostsOf(groups.memory(row)),
            model_.states(to));
  }
  operations_ += static_cast<double>(groups.size()) * source.states() * model_.states(to);
}

template <int kWords>
void WalkDp<kWords>::DropDead(int position, int cluster) {
  const std::vector<char>& alive =
      alive_[static_cast<size_t>(position)][static_cast<size_t>(cluster - FirstAt(position))];
  Rows& rows = target_.rows();
  for (size_t state = 0; state < alive.size(); ++state) {
    if (alive[state] != 0) continue;
    for (int row = 0; row < rows.size(); ++row) rows.costs(row)[state] = kUnreached;
  }
}

// A route remembers no cluster on both sides but the one it is at. False if the budget ran out.
template <int kWords>
bool WalkDp<kWords>::Prune(const Rows& completions, int cluster, double most_sum, Budget& budget) {
  Rows& rows = target_.rows();
  const int states = rows.states();
  const Memory bit = Bit(cluster);
  completion_.resize(static_cast<size_t>(states));
  for (int row = 0; row < rows.size(); ++row) {
    if (budget.Exhausted()) return false;
    double* costs = rows.costs(row);
    std::fill(completion_.begin(), completion_.end(), kUnreached);
    for (int other = 0; other < completions.size(); ++other) {
      if ((completions.memory(other) & rows.memory(row)) == bit) {
        ElementwiseMin(completions.costs(other), completion_.data(), states);
      }
    }
    for (int state = 0; state < states; ++state) {
      if (costs[state] + completion_[static_cast<size_t>(state)] > most_sum) {
        costs[state] = kUnreached;
      }
    }
  }
  return true;
}

// A walk that remembers more and costs no less can do nothing that the other cannot.
template <int kWords>
void WalkDp<kWords>::DropDominated() {
  Rows& rows = target_.rows();
  if (rows.size() < 2 || rows.size() > kMostRowsForDominance) return;
  for (int row = 0; row < rows.size(); ++row) {
    double* costs = rows.costs(row);
    for (int other = 0; other < rows.size(); ++other) {
      if (other == row || !rows.memory(other).IsSubsetOf(rows.memory(row))) continue;
      const double* less = rows.costs(other);
      for (int state = 0; state < rows.states(); ++state) {
        if (less[state] <= costs[state]) costs[state] = kUnreached;
      }
    }
  }
  rows.DropUnreached();
}

template <int kWords>
double WalkDp<kWords>::LowestCost() const {
  double lowest = kUnreached;
  for (size_t i = 0; i < forward_.back().size(); ++i) {
    const Rows& rows = forward_.back()[i];
    const double* finish = finish_[i].data();
    for (int row = 0; row < rows.size(); ++row) {
      for (int state = 0; state < rows.states(); ++state) {
        lowest = std::min(lowest, rows.costs(row)[state] + finish[state]);
      }
    }
  }
  return lowest - multiplier_sum_;
}

template <int kWords>
std::vector<ClusterState> WalkDp<kWords>::LowestWalk() const {
  const int last = positions() - 1;
  Origin at{-1, 0, 0};
  double lowest = kUnreached;
  for (size_t i = 0; i < forward_.back().size(); ++i) {
    const Rows& rows = forward_.back()[i];
    const int cluster = FirstAt(last) + static_cast<int>(i);
    const double* finish = finish_[i].data();
    for (int row = 0; row < rows.size(); ++row) {
      for (int state = 0; state < rows.states(); ++state) {
        const double cost = rows.costs(row)[state] + finish[state];
        if (cost < lowest) {
          lowest = cost;
          at = Origin{cluster, row, state};
        }
      }
    }
  }
  std::vector<ClusterState> walk;
  if (at.cluster < 0) return walk;
  for (int position = last;; --position) {
    walk.push_back({at.cluster, at.state});
    if (position == 0) break;
    at = FindOrigin(position, at.cluster, at.row, at.state);
  }
  std::reverse(walk.begin(), walk.end());
  return walk;
}

// The cell of the position before from which the cell given got its cost: the one whose cost, added
// up again, comes closest.
template <int kWords>
typename WalkDp<kWords>::Origin WalkDp<kWords>::FindOrigin(int position, int cluster, int row,
                                                           int state) const {
  const auto p = static_cast<size_t>(position);
  const Rows& rows = forward_[p][static_cast<size_t>(cluster - FirstAt(position))];
  const Memory& memory = rows.memory(row);
  const double cost = rows.costs(row)[state];
  const Memory bit = Bit(cluster);
  const auto c = static_cast<size_t>(cluster);
  const bool new_stage = StageAt(position - 1) != StageAt(position);
  Origin best;
  double least = kUnreached;
  for (size_t i = 0; i < forward_[p - 1].size(); ++i) {
    const Rows& sources = forward_[p - 1][i];
    const int from = FirstAt(position - 1) + static_cast<int>(i);
    if (!model_.CanFollow(from, cluster)) continue;
    const double* moves = model_.Move(from, cluster);
    for (int r = 0; r < sources.size(); ++r) {
      const Memory& remembered = sources.memory(r);
      if (!new_stage && (remembered.Intersects(bit) || remembered.Intersects(after_[c]) ||
                         !(((remembered & remembered_[c]) | bit) == memory))) {
        continue;
      }
      for (int s = 0; s < sources.states(); ++s) {
        if (sources.costs(r)[s] == kUnreached) continue;
        const double sum =
            sources.costs(r)[s] + multipliers_[c] + moves[s * model_.states(cluster) + state];
        if (std::abs(sum - cost) < least) {
          least = std::abs(sum - cost);
          best = Origin{from, r, s};
        }
      }
    }
  }
  return best;
}

template <int kWords>
std::vector<std::vector<double>> WalkDp<kWords>::LowestByEnd() const {
  std::vector<std::vector<double>> lowest;
  for (size_t i = 0; i < forward_.back().size(); ++i) {
    const Rows& rows = forward_.back()[i];
    std::vector<double>& ends = lowest.emplace_back(finish_[i].size(), kUnreached);
    for (int row = 0; row < rows.size(); ++row) {
      ElementwiseMin(rows.costs(row), ends.data(), rows.states());
    }
    for (double& end : ends) end -= multiplier_sum_;
  }
  return lowest;
}

template <int kWords>
void WalkDp<kWords>::Eliminate(double most_cost, Budget& budget) {
  assert(complete_[0] && complete_[1]);
  const double most_sum = most_cost + multiplier_sum_;
  for (int position = 0; position < positions(); ++position) {
    const auto p = static_cast<size_t>(position);
    for (size_t i = 0; i < alive_[p].size(); ++i) {
      std::vector<char>& alive = alive_[p][i];
      if (alive.empty()) continue;
      const Rows& ahead = backward_[p][i];
      target_.Clear(ahead.states());
      completion_.assign(alive.size(), kUnreached);
      const int cluster = FirstAt(position) + static_cast<int>(i);
      const Rows& behind = forward_[p][i];
      for (int row = 0; row < behind.size(); ++row) {
        if (budget.Exhausted()) return;
        for (int other = 0; other < ahead.size(); ++other) {
          if (!((behind.memory(row) & ahead.memory(other)) == Bit(cluster))) continue;
          for (size_t state = 0; state < alive.size(); ++state) {
            completion_[state] =
                std::min(completion_[state], behind.costs(row)[state] + ahead.costs(other)[state]);
          }
        }
      }
      bool any = false;
      for (size_t state = 0; state < alive.size(); ++state) {
        if (completion_[state] > most_sum) alive[state] = 0;
        any = any || alive[state] != 0;
      }
      if (!any) alive.clear();
    }
  }
}

template <int kWords>
int64_t WalkDp<kWords>::alive_states() const {
  int64_t count = 0;
  for (const auto& clusters : alive_) {
    for (const auto& states : clusters) count += std::count(states.begin(), states.end(), 1);
  }
  return count;
}

template class WalkDp<1>;
template class WalkDp<2>;
template class WalkDp<4>;
template class WalkDp<8>;

}  // namespace traverse
