#include "engine/proof/walks/stage_proof.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <memory>
#include <utility>

#include "engine/proof/walks/item_stage.h"
#include "engine/proof/walks/last_stage.h"

namespace traverse {
namespace {

// Relative to max(1, cost). Only routes cheaper than the best one less this are looked for: far
// above what rounding can add up to, far below what optimality is claimed at (kCostTolerance).
constexpr double kProofTolerance = 1e-9;

// Passes of walks between two updates of what the last stage is known to cost.
constexpr int kPassesPerRound = 60;

// Ends after which the last stage is bounded at the beginning.
constexpr int kSamples = 40;

class Proof {
 public:
  Proof(const StageModel& model, const std::vector<ClusterState>& walk,
        const StageProofOptions& options, Budget& budget)
      : model_(model), options_(options), budget_(budget) {
    result_.walk = walk;
    result_.cost = model.CostOf(walk);
  }

  StageProof Run() {
    const int last = model_.stage_count() - 1;
    const bool branch = last > 0 && model_.size(last) >= options_.least_items_to_branch &&
                        IsItemStage(model_, last);
    if (CanBranchAlone()) {
      BranchAlone();
      if (!result_.proven && !budget_.ExhaustedNow()) WalksAlone();
    } else if (branch) {
      Together();
    } else {
      WalksAlone();
    }
    return std::move(result_);
  }

 private:
  using Outcome = WalkProver::Outcome;

  double Limit() const { return result_.cost - kProofTolerance * std::max(1.0, result_.cost); }

  // A little less, so that what branch and cut has shown to be at the limit is beyond it for walks.
  double WalkLimit() const {
    return result_.cost - 2 * kProofTolerance * std::max(1.0, result_.cost);
  }

  void Raise(double bound) {
    result_.lower_bound = std::max(result_.lower_bound, std::min(bound, result_.cost));
    if (bound < WalkLimit()) return;
    result_.lower_bound = result_.cost;
    result_.proven = true;
  }

  void RaiseBy(Outcome outcome, const WalkProver& prover) {
    result_.passes = prover.passes();
    Raise(outcome == Outcome::kNothing ? result_.cost : prover.lower_bound());
  }

  void Take(const std::vector<ClusterState>& walk) {
    const double cost = model_.CostOf(walk);
    if (cost >= result_.cost) return;
    result_.walk = walk;
    result_.cost = cost;
  }

  bool CanBranchAlone() const {
    return model_.size(0) >= options_.least_items_to_branch && ItemStage::IsAll(model_);
  }

  void WalksAlone() {
    const auto prover = WalkProver::Make(model_, model_.stage_count(), options_.walks, budget_);
    Outcome outcome = Outcome::kPasses;
    while (outcome == Outcome::kPasses) {
      outcome = prover->Run(WalkLimit(), kPassesPerRound, budget_);
    }
    if (outcome == Outcome::kRoute) Take(prover->lowest());
    RaiseBy(outcome, *prover);
  }

  void BranchAlone() {
    ItemStage items(model_, 0);
    const ItemStage::Best best = items.Solve(items.StartOfModel(), Limit(), result_.walk, budget_);
    if (!best.walk.empty()) Take(best.walk);
    Raise(best.lower_bound);
    Count(items.solver());
  }

  void Together() {
    const auto prover = WalkProver::Make(model_, model_.stage_count() - 1, options_.walks, budget_);
    LastStage last(model_);
    last.Sample(kSamples, Limit(), budget_);
    std::vector<ClusterState> head = result_.walk;
    head.resize(static_cast<size_t>(model_.first(model_.stage_count() - 1)));
    Continue(last, head);
    bool goes_on = true;
    while (goes_on && !result_.proven) {
      prover->SetFinish(last.Finish());
      const Outcome outcome = prover->Run(WalkLimit(), kPassesPerRound, budget_);
      RaiseBy(outcome, *prover);
      if (result_.proven || outcome == Outcome::kStopped) break;
      goes_on = outcome == Outcome::kRoute ? Continue(last, prover->lowest())
                                           : Continue(last, prover->EndBounds(budget_));
    }
    Count(last.solver());
  }

  // The best last stage after `head`, a route of the stages before. Like the next one, false if
  // there is no use in going on.
  bool Continue(LastStage& last, const std::vector<ClusterState>& head) {
    Budget share = Share();
    const ItemStage::Best best = last.Solve(last.StartAfter(head.back(), model_.CostBefore(head)),
                                            Limit(), result_.walk, share);
    if (!best.walk.empty()) {
      std::vector<ClusterState> walk = head;
      walk.insert(walk.end(), best.walk.begin(), best.walk.end());
      Take(walk);
    }
    return GoesOn(best, share);
  }

  // The best last stage after the cheapest ways to get to it that there may be.
  bool Continue(LastStage& last, const LastStage::EndCosts& ends) {
    if (ends.empty()) return false;
    Budget share = Share();
    const ItemStage::Best best = last.Solve(last.StartAfter(ends), Limit(), result_.walk, share);
    Raise(best.lower_bound);
    return !budget_.ExhaustedNow();
  }

  // Where there is a deadline, half of what is left: the other stages need some too.
  Budget Share() const { return budget_.WithShare(0.5); }

  // Something else than time may have ended a search: after the same route it would end again.
  bool GoesOn(const ItemStage::Best& best, const Budget& share) {
    return !budget_.ExhaustedNow() && (best.complete || share.was_exhausted());
  }

  void Count(const PathTspSolver& solver) {
    result_.nodes = solver.nodes();
    result_.cuts = solver.cuts();
  }

  const StageModel& model_;
  const StageProofOptions options_;
  Budget& budget_;
  StageProof result_;
};

}  // namespace

StageProof ProveByStages(const StageModel& model, const std::vector<ClusterState>& walk,
                         const StageProofOptions& options, Budget& budget) {
  assert(model.cluster_count() > 0);
  return Proof(model, walk, options, budget).Run();
}

}  // namespace traverse
