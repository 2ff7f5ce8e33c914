// The known costs of a last stage of items: lower bounds by the state in which it begins, and the
// moves that lead there from the stage before.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_LAST_STAGE_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_LAST_STAGE_H_

#include <cstddef>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/walks/item_stage.h"
#include "engine/proof/walks/stage_model.h"

namespace traverse {

class LastStage {
 public:
  // Costs of ends of the stage before: [cluster - first of that stage][state].
  using EndCosts = std::vector<std::vector<double>>;

  // REQUIRES: the model has two stages or more, the last with two clusters or more, IsItemStage.
  explicit LastStage(const StageModel& model);

  // Start costs of the last stage after a route of the other stages that ends in `from` and costs
  // `cost`; or the least costs after any end, kUnreached where all of `ends` are.
  std::vector<double> StartAfter(ClusterState from, double cost) const;
  std::vector<double> StartAfter(const EndCosts& ends) const;

  // The least known cost of all that follows each end, including the move to the last stage. Never
  // falls.
  EndCosts Finish() const;

  // Solves the stage for `start` (ItemStage::Solve) and learns from the result: if no path
  // through it costs less than w, then none that begins in e costs less than w - start[e], start
  // excluded.
  ItemStage::Best Solve(const std::vector<double>& start, double limit,
                        const std::vector<ClusterState>& known, Budget& budget);

  // Learns quickly: bounds the stage after each of `samples` ends that lie far from each other.
  void Sample(int samples, double limit, Budget& budget);

  const PathTspSolver& solver() const { return items_.solver(); }

 private:
  template <typename Visit>
  void ForEachMove(const Visit& visit) const;
  void Learn(const std::vector<double>& start, double bound);

  const StageModel& model_;
  const int stage_;  // the one before the last
  ItemStage items_;
  std::vector<double> least_;  // [state index of items_] no path that begins here costs less
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_LAST_STAGE_H_
