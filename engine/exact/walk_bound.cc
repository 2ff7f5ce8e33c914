#include "engine/exact/walk_bound.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "engine/exact/multiplier_search.h"
#include "engine/exact/walk_conflicts.h"
#include "engine/exact/walk_dp.h"

namespace traverse {
namespace {

// Relative. Cells that cost more than the best route less this are dropped: far above what rounding
// can add up to, far below what optimality is claimed at (kCostTolerance).
constexpr double kProofTolerance = 1e-9;

// Gaps, relative to the best route, below which elimination is tried, and by how much a gap has to
// become smaller for it to be worth another pass.
constexpr double kFirstEliminationGap = 0.1;
constexpr double kEliminationShrink = 0.75;

// A pass gains if it makes the gap smaller by this share; steps become shorter after some passes
// without a gain, and memory larger if it had some time.
constexpr double kGain = 0.02;
constexpr int kPassesWithoutGain = 6;
constexpr int kPassesBetweenGrowth = 10;

template <int kWords>
class WalkBound {
 public:
  WalkBound(const StageModel& model, const WalkBoundOptions& options, Budget& budget)
      : model_(model),
        options_(options),
        budget_(budget),
        dp_(model),
        search_(static_cast<size_t>(model.cluster_count())) {}

  WalkBoundResult Run(const std::vector<ClusterState>& walk) {
    best_.walk = walk;
    best_.cost = model_.CostOf(walk);
    elimination_gap_ = kFirstEliminationGap * best_.cost;
    RememberNearest();
    while (!best_.proven && best_.passes < options_.most_passes && Pass()) {
    }
    return best_;
  }

 private:
  using Dp = WalkDp<kWords>;
  using Direction = typename Dp::Direction;

  // What a walk may cost to be of interest.
  double MostCost() const { return best_.cost * (1 - kProofTolerance); }

  void Prove() {
    best_.proven = true;
    best_.lower_bound = best_.cost;
  }

  // One evaluation of the bound. False if it could not be completed.
  bool Pass() {
    ++best_.passes;
    if (!Fill(Direction::kForward, false)) return false;
    const double value = dp_.LowestCost();
    if (value >= MostCost()) {
      Prove();
      return true;
    }
    const std::vector<ClusterState> lowest = dp_.LowestWalk();
    std::vector<WalkConflict> conflicts = ConflictsOf(model_, lowest);
    if (conflicts.empty()) {
      best_.walk = lowest;
      best_.cost = model_.CostOf(lowest);
      Prove();
      return true;
    }
    std::move(conflicts.begin(), conflicts.end(), std::back_inserter(conflicts_));
    TakeValue(value);
    Step(value, lowest);
    return true;
  }

  bool Fill(Direction direction, bool prune) {
    return dp_.Run(direction, prune, MostCost(), options_.most_operations, budget_) ==
           Dp::Outcome::kDone;
  }

  void TakeValue(double value) {
    const double gap = best_.cost - best_.lower_bound;
    without_gain_ = value > best_.lower_bound + kGain * gap ? 0 : without_gain_ + 1;
    ++since_growth_;
    if (!search_.Take(dp_.multipliers(), value)) return;
    best_.lower_bound = std::max(0.0, value);
    if (best_.cost - value > kEliminationShrink * elimination_gap_) return;
    elimination_gap_ = best_.cost - value;
    if (Fill(Direction::kBackward, true)) dp_.Eliminate(MostCost());
  }

  void Step(double value, const std::vector<ClusterState>& lowest) {
    if (without_gain_ >= kPassesWithoutGain) {
      without_gain_ = 0;
      dp_.SetMultipliers(search_.best());
      search_.Shorten();
      if (since_growth_ >= kPassesBetweenGrowth) Grow();
      return;
    }
    std::vector<int> visits(static_cast<size_t>(model_.cluster_count()));
    for (const ClusterState& at : lowest) ++visits[static_cast<size_t>(at.cluster)];
    dp_.SetMultipliers(search_.Next(dp_.multipliers(), value, best_.cost, visits));
  }

  // Makes the shortest conflicts seen impossible.
  void Grow() {
    since_growth_ = 0;
    search_.Lengthen();
    std::stable_sort(conflicts_.begin(), conflicts_.end(),
                     [](const WalkConflict& a, const WalkConflict& b) {
                       return a.between.size() < b.between.size();
                     });
    const int most = std::max(8, model_.cluster_count() / 2);
    int added = 0;
    for (const WalkConflict& conflict : conflicts_) {
      if (added >= most) break;
      for (const int cluster : conflict.between) {
        if (dp_.Remember(cluster, conflict.remembered)) ++added;
      }
    }
    conflicts_.clear();
  }

  void RememberNearest() {
    for (int c = 0; c < model_.cluster_count(); ++c) {
      const int stage = model_.stage_of(c);
      std::vector<std::pair<double, int>> near;
      for (int other = model_.first(stage); other < model_.first(stage + 1); ++other) {
        if (other == c) continue;
        const int moves = model_.states(c) * model_.states(other);
        near.emplace_back(
            std::min(*std::min_element(model_.Move(c, other), model_.Move(c, other) + moves),
                     *std::min_element(model_.Move(other, c), model_.Move(other, c) + moves)),
            other);
      }
      std::sort(near.begin(), near.end());
      for (int i = 0; i < static_cast<int>(near.size()) && i + 1 < options_.first_memory; ++i) {
        dp_.Remember(c, near[static_cast<size_t>(i)].second);
      }
    }
  }

  const StageModel& model_;
  const WalkBoundOptions options_;
  Budget& budget_;
  Dp dp_;
  MultiplierSearch search_;
  WalkBoundResult best_;

  double elimination_gap_ = 0;           // at the last elimination
  int without_gain_ = 0;                 // passes
  int since_growth_ = 0;                 // passes
  std::vector<WalkConflict> conflicts_;  // of the lowest walks since the last growth
};

}  // namespace

WalkBoundResult BoundByWalks(const StageModel& model, const std::vector<ClusterState>& walk,
                             const WalkBoundOptions& options, Budget& budget) {
  int largest = 0;
  for (int s = 0; s < model.stage_count(); ++s) largest = std::max(largest, model.size(s));
  if (largest <= MemorySet<1>::kCapacity) return WalkBound<1>(model, options, budget).Run(walk);
  if (largest <= MemorySet<2>::kCapacity) return WalkBound<2>(model, options, budget).Run(walk);
  if (largest <= MemorySet<4>::kCapacity) return WalkBound<4>(model, options, budget).Run(walk);
  return WalkBound<8>(model, options, budget).Run(walk);
}

}  // namespace traverse
