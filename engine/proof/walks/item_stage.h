// A stage of a model as a path TSP.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_ITEM_STAGE_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_ITEM_STAGE_H_

#include <cstddef>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/tsp/path_tsp.h"
#include "engine/proof/walks/stage_model.h"

namespace traverse {

// Whether all clusters of `stage` are open paths that may be done both ways or clusters with one
// point, in any order: the kind that path_tsp.h can solve.
bool IsItemStage(const StageModel& model, int stage);

// The same if contours of few points are among them, and not too many points in all: for these
// path_tsp.h is better than walks.
bool IsPortStage(const StageModel& model, int stage);

class ItemStage {
 public:
  struct Best {
    double lower_bound = 0;
    // From this stage on; empty if none is cheaper than the limit.
    std::vector<ClusterState> walk;
    bool complete = false;
  };

  // REQUIRES: IsItemStage or IsPortStage, at least two clusters, and at most one in all the stages
  // that follow.
  ItemStage(const StageModel& model, int stage);

  // Whether the first stage is one of these and the only one, except for a cluster that must be
  // last.
  static bool IsAll(const StageModel& model);

  // States of the stage are numbered from 0.
  int state_count() const { return state_count_; }
  size_t StateIndex(ClusterState at) const {
    return static_cast<size_t>(first_[static_cast<size_t>(at.cluster - first_cluster_)] + at.state);
  }

  // The model's start costs, for a model of one stage.
  std::vector<double> StartOfModel() const;

  // The cheapest walk of the stage, if it is cheaper than `limit`. `start`: cost of beginning in
  // each state. `known`: a route of the model to start from.
  Best Solve(const std::vector<double>& start, double limit, const std::vector<ClusterState>& known,
             Budget& budget);

  // A lower bound of the cost of Solve's walk; quicker.
  double Bound(const std::vector<double>& start, double limit, Budget& budget,
               double most_work = PathTspSolver::kUnlimited) {
    return solver_.RootBound(start, limit, budget, most_work);
  }

  const PathTspSolver& solver() const { return solver_; }

 private:
  static PathTsp MakeTsp(const StageModel& model, int stage);
  bool Has(int cluster) const {
    return cluster >= first_cluster_ && cluster < first_cluster_ + static_cast<int>(first_.size());
  }

  const StageModel& model_;
  const int first_cluster_;
  std::vector<int> first_;  // [cluster - first_cluster_] the index of its first state
  int state_count_ = 0;
  PathTspSolver solver_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_ITEM_STAGE_H_
