// A layer as stages of clusters: the abstract problem that the exact methods solve.
//
// A plan is a sequence of stages (plan_stages.h). In each stage every cluster (a path) is done
// once, in one of its states (an entry), in any order that keeps the stage's precedences and goes
// from one cluster to another that can follow it. Of the geometry only the cost of going from a
// state of one cluster to a state of another remains:
//
//   start -> | stage 0: clusters in any order | -> | stage 1: ... | -> finish
//
// This is a generalised travelling salesman path with stages (SPEC section 2). The gate of a block
// is a cluster too: its states are the entries where the block may begin, and each leads only to
// that entry, at no cost.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_STAGE_MODEL_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_STAGE_MODEL_H_

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/cost/entry_table.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"
#include "engine/proof/walks/plan_stages.h"

namespace traverse {

// A cluster in one of its states.
struct ClusterState {
  int cluster = 0;
  int state = 0;
  friend bool operator==(const ClusterState&, const ClusterState&) = default;
};

// Immutable once built. Clusters are numbered stage by stage; no stage is empty.
class StageModel {
 public:
  // The model of `problem`, or nothing if a stage has more than kMostClusters, if the matrices or
  // the pairs of clusters of one stage or of two in a row would exceed `max_entries` numbers, or
  // if `budget` (may be null) ends. Time and memory are proportional to these: 16 million take 0.2
  // s.
  static constexpr size_t kMostClusters = 512;
  static std::optional<StageModel> Build(const LayerProblem& problem, size_t max_entries,
                                         Budget* budget = nullptr);

  // Whether Build has a model for `plan` if `budget` (may be null) lasts. Much quicker.
  static bool Fits(const Plan& plan, size_t max_entries, Budget* budget = nullptr);

  int stage_count() const { return static_cast<int>(first_.size()) - 1; }
  int cluster_count() const { return first_.back(); }

  // The clusters of `stage` are [first(stage), first(stage + 1)).
  int first(int stage) const { return first_[static_cast<size_t>(stage)]; }
  int size(int stage) const { return first(stage + 1) - first(stage); }
  int stage_of(int cluster) const { return stage_of_[static_cast<size_t>(cluster)]; }

  int states(int cluster) const { return static_cast<int>(visits(cluster).size()); }

  // Whether `cluster` is an open path that may be done both ways, or has only one point: then its
  // states are its ends, and it is left at the other end.
  bool IsItem(int cluster) const { return is_item_[static_cast<size_t>(cluster)] != 0; }

  // Whether `cluster` is a contour, which is left where it was entered.
  bool IsContour(int cluster) const { return is_contour_[static_cast<size_t>(cluster)] != 0; }

  // Whether `b` may come right after `a`: it is in the same stage or in the next one.
  bool CanFollow(int a, int b) const {
    const int stage = stage_of(a);
    return b >= first(stage) && b < end_of_next(stage) && offset(a, b) != kNoMoves;
  }

  // Whether any two clusters of `stage` may follow each other, except for precedences.
  bool IsFree(int stage) const { return is_free_[static_cast<size_t>(stage)] != 0; }

  // Cost of moves from `a` to `b`, [state of a * states(b) + state of b]. REQUIRES: CanFollow.
  const double* Move(int a, int b) const {
    assert(CanFollow(a, b));
    return &costs_[offset(a, b)];
  }

  // The same numbers, [state of b * states(a) + state of a].
  const double* MoveTransposed(int a, int b) const {
    assert(CanFollow(a, b));
    return &transposed_[offset(a, b)];
  }

  // Cost from the start to each state, kUnreached if it cannot come first. REQUIRES: `cluster` is
  // in the first stage.
  const double* Start(int cluster) const {
    assert(stage_of(cluster) == 0);
    return start_[static_cast<size_t>(cluster)].data();
  }

  // Cost from each state to the finish: 0 if there is none, kUnreached if `cluster` cannot come
  // last. REQUIRES: `cluster` is in the last stage.
  const double* Finish(int cluster) const {
    assert(stage_of(cluster) == stage_count() - 1);
    return finish_[static_cast<size_t>(cluster - first(stage_count() - 1))].data();
  }

  // The clusters of the same stage that must come before, or after, `cluster`; transitive.
  const std::vector<int>& Before(int cluster) const {
    return before_[static_cast<size_t>(cluster)];
  }
  const std::vector<int>& After(int cluster) const { return after_[static_cast<size_t>(cluster)]; }

  // The route of a walk that visits each cluster once, which drops gates; and back, adding them.
  Route RouteOf(const std::vector<ClusterState>& walk) const;
  std::vector<ClusterState> WalkOf(const Route& route) const;

  // Sum of the costs of the moves of `walk`, which need not be a route: with the move to the
  // finish, and without it. Without it, `walk` may end in any stage.
  double CostOf(const std::vector<ClusterState>& walk) const;
  double CostBefore(const std::vector<ClusterState>& walk) const;

 private:
  static constexpr size_t kNoMoves = std::numeric_limits<size_t>::max();

  StageModel() = default;
  // REQUIRES: `b` is in the stage of `a` or in the next one.
  size_t offset(int a, int b) const {
    assert(b >= first(stage_of(a)) && b < end_of_next(stage_of(a)));
    return offsets_[row_[static_cast<size_t>(a)] + static_cast<size_t>(b - first(stage_of(a)))];
  }
  // One past the last cluster of the stage after `stage`, or of `stage` if that is the last one.
  int end_of_next(int stage) const { return first(std::min(stage + 2, stage_count())); }
  bool IsGate(int cluster) const { return is_gate_[static_cast<size_t>(cluster)] != 0; }
  // The visits that the states of `cluster` stand for.
  absl::Span<const Visit> visits(int cluster) const {
    const size_t first = first_visit_[static_cast<size_t>(cluster)];
    return absl::MakeConstSpan(visits_).subspan(
        first, first_visit_[static_cast<size_t>(cluster) + 1] - first);
  }
  void AddStage(const Plan& plan, const EntryTable& entries, const PlanStage& stage);
  void AddVisits(const EntryTable& entries, const PlanStage& stage);
  bool LayOut(const Plan& plan, size_t max_entries, Budget* budget);
  bool PlaceMatrices(std::deque<PlanStage> stages, size_t max_entries, Budget* budget);
  bool FillMatrices(const LayerProblem& problem, Budget* budget);
  void FillEnds(const LayerProblem& problem);

  std::vector<int> first_;              // [stage], stage_count() + 1 of them
  std::vector<int> stage_of_;           // [cluster]
  std::vector<size_t> first_visit_{0};  // [cluster] in visits_; one more at the end
  std::vector<Visit> visits_;           // those of each cluster by states
  std::vector<char> is_item_;           // [cluster]
  std::vector<char> is_contour_;        // [cluster]
  std::vector<char> is_gate_;           // [cluster]
  std::vector<PlanStage::Gate> gates_;  // in clusters, by stages; inner ones first
  std::vector<char> is_free_;           // [stage]
  std::vector<char> begins_;            // [cluster] whether it may come first in its stage
  std::vector<char> ends_;              // [cluster] whether it may come last
  size_t move_count_ = 0;
  std::vector<size_t> row_;                  // [a] where its offsets begin
  std::vector<size_t> offsets_;              // [row + b - first cluster of the stage of a]
  std::vector<double> costs_;                // [offset + ...]
  std::vector<double> transposed_;           // [offset + ...]
  std::vector<std::vector<double>> start_;   // [cluster][state]
  std::vector<std::vector<double>> finish_;  // [cluster of the last stage][state]
  std::vector<std::vector<int>> before_;     // [cluster]
  std::vector<std::vector<int>> after_;      // [cluster]
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_STAGE_MODEL_H_
