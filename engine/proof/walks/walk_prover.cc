#include "engine/proof/walks/walk_prover.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <iterator>
#include <utility>

#include "engine/proof/min_plus.h"
#include "engine/proof/walks/multiplier_search.h"
#include "engine/proof/walks/walk_conflicts.h"
#include "engine/proof/walks/walk_dp.h"

namespace traverse {
namespace {

// Gaps, relative to the limit, below which elimination is tried, and by how much a gap has to
// become smaller for it to be worth another pass.
constexpr double kFirstEliminationGap = 0.1;
constexpr double kEliminationShrink = 0.75;

// A pass gains if it makes the gap smaller by this share; steps become shorter after some passes
// without a gain, and memory larger if it had some time.
constexpr double kGain = 0.02;
constexpr int kPassesWithoutGain = 6;
constexpr int kPassesBetweenGrowth = 10;

[[maybe_unused]] bool CostsNoLess(const std::vector<std::vector<double>>& finish,
                                  const std::vector<std::vector<double>>& before) {
  for (size_t c = 0; c < before.size(); ++c) {
    if (!std::equal(before[c].begin(), before[c].end(), finish[c].begin(), finish[c].end(),
                    std::less_equal<>())) {
      return false;
    }
  }
  return true;
}

template <int kWords>
class Prover : public WalkProver {
 public:
  Prover(const StageModel& model, int stages, const Options& options, Budget& budget)
      : model_(model),
        options_(options),
        dp_(model, stages),
        search_(static_cast<size_t>(model.first(stages))) {
    RememberNearest(budget);
  }

  void SetFinish(std::vector<std::vector<double>> finish) override {
    assert(CostsNoLess(finish, dp_.finish()));
    dp_.SetFinish(std::move(finish));
  }

  Outcome Run(double limit, int most_passes, Budget& budget) override {
    assert(limit <= limit_);
    limit_ = limit;
    budget_ = &budget;
    if (elimination_gap_ == 0) elimination_gap_ = kFirstEliminationGap * limit;
    for (int pass = 0; pass < most_passes; ++pass) {
      const Outcome outcome = Pass();
      if (outcome != Outcome::kPasses) return outcome;
    }
    return Outcome::kPasses;
  }

  double lower_bound() const override { return search_.best_value(); }
  const std::vector<ClusterState>& lowest() const override { return lowest_; }
  int passes() const override { return passes_; }

  std::vector<std::vector<double>> EndBounds(Budget& budget) override {
    budget_ = &budget;
    SetMultipliers(search_.best());
    if (!Fill(Direction::kForward, false)) return {};
    return dp_.LowestByEnd();
  }

 private:
  using Dp = WalkDp<kWords>;
  using Direction = typename Dp::Direction;

  // One evaluation of the bound. kPasses: nothing special.
  Outcome Pass() {
    ++passes_;
    if (!Fill(Direction::kForward, false)) return Outcome::kStopped;
    const double value = dp_.LowestCost();
    if (value >= limit_) {
      search_.Take(multipliers_, limit_);
      return Outcome::kNothing;
    }
    lowest_ = dp_.LowestWalk();
    TakeValue(value);
    std::vector<WalkConflict> conflicts = ConflictsOf(model_, lowest_);
    if (conflicts.empty()) return Outcome::kRoute;
    std::move(conflicts.begin(), conflicts.end(), std::back_inserter(conflicts_));
    Step(value);
    return Outcome::kPasses;
  }

  bool Fill(Direction direction, bool prune) {
    return dp_.Run(direction, prune, limit_, options_.most_operations, *budget_) ==
           Dp::Outcome::kDone;
  }

  void SetMultipliers(const std::vector<double>& multipliers) {
    multipliers_ = multipliers;
    dp_.SetMultipliers(multipliers);
  }

  void TakeValue(double value) {
    const double best = search_.best_value();
    without_gain_ = value > best + kGain * (limit_ - best) ? 0 : without_gain_ + 1;
    ++since_growth_;
    if (!search_.Take(multipliers_, value)) return;
    if (limit_ - value > kEliminationShrink * elimination_gap_) return;
    elimination_gap_ = limit_ - value;
    if (Fill(Direction::kBackward, true)) dp_.Eliminate(limit_, *budget_);
  }

  void Step(double value) {
    if (without_gain_ >= kPassesWithoutGain) {
      without_gain_ = 0;
      SetMultipliers(search_.best());
      search_.Shorten();
      if (since_growth_ >= kPassesBetweenGrowth) Grow();
      return;
    }
    std::vector<int> visits(multipliers_.size());
    for (const ClusterState& at : lowest_) ++visits[static_cast<size_t>(at.cluster)];
    SetMultipliers(search_.Next(multipliers_, value, limit_, visits));
  }

  // Makes the shortest conflicts seen impossible.
  void Grow() {
    since_growth_ = 0;
    search_.Lengthen();
    std::stable_sort(conflicts_.begin(), conflicts_.end(),
                     [](const WalkConflict& a, const WalkConflict& b) {
                       return a.between.size() < b.between.size();
                     });
    const int most = std::max(8, static_cast<int>(multipliers_.size()) / 2);
    int added = 0;
    for (const WalkConflict& conflict : conflicts_) {
      if (added >= most) break;
      for (const int cluster : conflict.between) {
        if (dp_.Remember(cluster, conflict.remembered)) ++added;
      }
    }
    conflicts_.clear();
  }

  double Shortest(int a, int b) const {
    if (!model_.CanFollow(a, b)) return kUnreached;
    const double* moves = model_.Move(a, b);
    return *std::min_element(moves, moves + model_.states(a) * model_.states(b));
  }

  // Looks at all costs between two clusters, which are many.
  void RememberNearest(Budget& budget) {
    for (int c = 0; c < static_cast<int>(multipliers_.size()); ++c) {
      if (budget.Exhausted()) return;
      const int stage = model_.stage_of(c);
      std::vector<std::pair<double, int>> near;
      for (int other = model_.first(stage); other < model_.first(stage + 1); ++other) {
        if (other == c) continue;
        const double nearest = std::min(Shortest(c, other), Shortest(other, c));
        if (nearest < kUnreached) near.emplace_back(nearest, other);
      }
      std::sort(near.begin(), near.end());
      for (int i = 0; i < static_cast<int>(near.size()) && i + 1 < options_.first_memory; ++i) {
        dp_.Remember(c, near[static_cast<size_t>(i)].second);
      }
    }
  }

  const StageModel& model_;
  const Options options_;
  Budget* budget_ = nullptr;
  Dp dp_;
  MultiplierSearch search_;
  std::vector<double> multipliers_ = search_.best();

  double limit_ = std::numeric_limits<double>::infinity();
  std::vector<ClusterState> lowest_;
  double elimination_gap_ = 0;  // at the last elimination
  int passes_ = 0;
  int without_gain_ = 0;                 // passes
  int since_growth_ = 0;                 // passes
  std::vector<WalkConflict> conflicts_;  // of the lowest walks since the last growth
};

}  // namespace

std::unique_ptr<WalkProver> WalkProver::Make(const StageModel& model, int stages,
                                             const Options& options, Budget& budget) {
  assert(1 <= stages && stages <= model.stage_count());
  int largest = 0;
  for (int s = 0; s < stages; ++s) largest = std::max(largest, model.size(s));
  if (largest <= MemorySet<1>::kCapacity) {
    return std::make_unique<Prover<1>>(model, stages, options, budget);
  }
  if (largest <= MemorySet<2>::kCapacity) {
    return std::make_unique<Prover<2>>(model, stages, options, budget);
  }
  if (largest <= MemorySet<4>::kCapacity) {
    return std::make_unique<Prover<4>>(model, stages, options, budget);
  }
  return std::make_unique<Prover<8>>(model, stages, options, budget);
}

}  // namespace traverse
