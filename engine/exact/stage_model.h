// A layer as stages of clusters: the abstract problem that the exact methods solve.
//
// A plan that is an in_order of any_orders over paths is a sequence of stages; in each stage every
// cluster (a path) is done once, in one of its states (an entry), in any order that keeps the
// stage's precedences. What is left of geometry is the cost of going from a state of one cluster to
// a state of another:
//
//   start -> | stage 0: clusters in any order | -> | stage 1: ... | -> finish
//
// This is a generalised travelling salesman path with stages (SPEC section 2).

#ifndef TRAVERSE_ENGINE_EXACT_STAGE_MODEL_H_
#define TRAVERSE_ENGINE_EXACT_STAGE_MODEL_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/model/layer_problem.h"
#include "engine/model/route.h"

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
  // The model of `problem`, or nothing if its plan has another shape, or if the matrices would have
  // more than `max_entries` numbers, or if `budget` (may be null) ends. Time and memory are
  // proportional to these: 16 million take 0.2 s.
  static std::optional<StageModel> Build(const LayerProblem& problem, size_t max_entries,
                                         Budget* budget = nullptr);

  int stage_count() const { return static_cast<int>(first_.size()) - 1; }
  int cluster_count() const { return first_.back(); }

  // The clusters of `stage` are [first(stage), first(stage + 1)).
  int first(int stage) const { return first_[static_cast<size_t>(stage)]; }
  int size(int stage) const { return first(stage + 1) - first(stage); }
  int stage_of(int cluster) const { return stage_of_[static_cast<size_t>(cluster)]; }

  int states(int cluster) const {
    return static_cast<int>(visits_[static_cast<size_t>(cluster)].size());
  }

  // Whether `cluster` is an open path that may be done both ways, or has one point only: then
  // states are its ends, and it is left at the other one.
  bool IsItem(int cluster) const { return is_item_[static_cast<size_t>(cluster)] != 0; }

  // Cost of moves from `a` to `b`, [state of a * states(b) + state of b].
  // REQUIRES: a != b, and b is of the stage of a or of the next one.
  const double* Move(int a, int b) const { return &costs_[offset(a, b)]; }

  // The same numbers, [state of b * states(a) + state of a].
  const double* MoveTransposed(int a, int b) const { return &transposed_[offset(a, b)]; }

  // Cost from the start to each state. REQUIRES: `cluster` is of the first stage.
  const double* Start(int cluster) const { return start_[static_cast<size_t>(cluster)].data(); }

  // Cost from each state to the finish, 0 if there is none. REQUIRES: `cluster` is of the last
  // stage.
  const double* Finish(int cluster) const {
    return finish_[static_cast<size_t>(cluster - first(stage_count() - 1))].data();
  }

  // The clusters of the same stage that come before, or after, `cluster`; transitive.
  const std::vector<int>& Before(int cluster) const {
    return before_[static_cast<size_t>(cluster)];
  }
  const std::vector<int>& After(int cluster) const { return after_[static_cast<size_t>(cluster)]; }

  // The route of a walk that visits each cluster once, and back.
  Route RouteOf(const std::vector<ClusterState>& walk) const;
  std::vector<ClusterState> WalkOf(const Route& route) const;

  // Sum of the costs of the moves of `walk`, whether or not it is a route: with the move to the
  // finish, and before it. `walk` may end in any stage for the latter.
  double CostOf(const std::vector<ClusterState>& walk) const;
  double CostBefore(const std::vector<ClusterState>& walk) const;

 private:
  StageModel() = default;
  size_t offset(int a, int b) const {
    return offsets_[static_cast<size_t>(a) * static_cast<size_t>(cluster_count()) +
                    static_cast<size_t>(b)];
  }
  bool AllocateMatrices(size_t max_entries);
  bool FillMatrices(const LayerProblem& problem, Budget* budget);

  std::vector<int> first_;                   // [stage], stage_count() + 1 of them
  std::vector<int> stage_of_;                // [cluster]
  std::vector<std::vector<Visit>> visits_;   // [cluster][state]
  std::vector<char> is_item_;                // [cluster]
  std::vector<size_t> offsets_;              // [a * cluster_count() + b]
  std::vector<double> costs_;                // [offset + ...]
  std::vector<double> transposed_;           // [offset + ...]
  std::vector<std::vector<double>> start_;   // [cluster][state]
  std::vector<std::vector<double>> finish_;  // [cluster of the last stage][state]
  std::vector<std::vector<int>> before_;     // [cluster]
  std::vector<std::vector<int>> after_;      // [cluster]
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_EXACT_STAGE_MODEL_H_
