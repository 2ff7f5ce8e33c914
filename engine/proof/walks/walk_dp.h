// Dynamic programming over walks with memory: lower bounds for the routes of a stage model.
//
// Walks (ng-routes: Baldacci, Mingozzi and Roberti 2011, "New route relaxation and pricing
// strategies for the vehicle routing problem") have one cluster at each position of each stage, as
// routes have, but may visit a cluster again once they have forgotten it. Each cluster c has a set
// remembered(c) of clusters of its stage, c among them; a walk that comes to c keeps
//
//   memory' = (memory & remembered(c)) + {c},  allowed if c is not in memory
//
// With all clusters in all sets only routes are left; with small ones there are few cells. A
// multiplier for each cluster, paid at each visit and paid back once, makes walks visit what they
// would rather skip; it changes no route's cost (Lagrangian relaxation of "once each").
//
// A cell is (position, cluster, memory, state); forward it holds the least cost from the start to
// it, backward from it to the finish. The sum of both bounds all routes that are in this state at
// this position; where it is above what a route is known to cost, the cell is dropped for good.
// This is successive sublimation (Ibaraki 1987; Tanaka, Fujikuma and Araki 2009, "An exact
// algorithm for single-machine scheduling without machine idle time").
//
// Time of a pass is about the sum over positions and pairs of clusters of memories x states^2.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_WALK_DP_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_WALK_DP_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/walks/memory_rows.h"
#include "engine/proof/walks/memory_set.h"
#include "engine/proof/walks/stage_model.h"

namespace traverse {

template <int kWords>
class WalkDp {
 public:
  using Memory = MemorySet<kWords>;
  enum class Direction { kForward, kBackward };
  enum class Outcome {
    kDone,     // the table is complete
    kStopped,  // the budget ran out
    kTooBig,   // it would take more operations than allowed
  };

  // For stages [0, stages) of `model`, which outlives this. Later costs are 0, or the finish of the
  // model if these are all its stages. REQUIRES: no stage has more than Memory::kCapacity clusters.
  WalkDp(const StageModel& model, int stages);

  int positions() const { return static_cast<int>(stage_at_.size()); }

  // Tables made before a change of multipliers or finish no longer serve to prune.
  void SetMultipliers(const std::vector<double>& multipliers);  // [cluster]

  // Costs after the last stage, [cluster - first of that stage][state].
  void SetFinish(std::vector<std::vector<double>> finish);
  const std::vector<std::vector<double>>& finish() const { return finish_; }

  // Makes `cluster` remember `other`. True if that is new. REQUIRES: both are in one stage.
  bool Remember(int cluster, int other);
  bool Remembers(int cluster, int other) const;

  // Computes the table of `direction`. With `prune`, drops cells that cannot be completed at a cost
  // of at most `most_cost` according to the other direction's table, which was made with the same
  // multipliers and finish and with the same or smaller memory.
  Outcome Run(Direction direction, bool prune, double most_cost, double most_operations,
              Budget& budget);

  // Least cost of a walk in the forward table, and such a walk; kUnreached and none if it is empty.
  double LowestCost() const;
  std::vector<ClusterState> LowestWalk() const;

  // Least cost, without the finish, of a walk that ends in each state of each cluster of the last
  // stage: [cluster - first of that stage][state].
  std::vector<std::vector<double>> LowestByEnd() const;

  // Drops for good the cells that both tables show to cost more than `most_cost`. REQUIRES: both
  // tables are complete and made with the current multipliers. Ends early, with less dropped, when
  // the budget runs out.
  void Eliminate(double most_cost, Budget& budget);

  // The number of (position, cluster, state) that were not dropped for good.
  int64_t alive_states() const;

 private:
  using Rows = MemoryRows<kWords>;
  using Table = std::vector<std::vector<Rows>>;  // [position][cluster - first of its stage]

  // The origin of a row of a table.
  struct Origin {
    int cluster = 0;
    int row = 0;
    int state = 0;
  };

  int StageAt(int position) const { return stage_at_[static_cast<size_t>(position)]; }
  int FirstAt(int position) const { return model_.first(StageAt(position)); }
  Table& table(Direction direction) {
    return direction == Direction::kForward ? forward_ : backward_;
  }
  Memory Bit(int cluster) const {
    return Memory::Of(cluster - model_.first(model_.stage_of(cluster)));
  }

  const double* Finish(int cluster) const;
  void FillFirst(Direction direction, int cluster);
  void Extend(Direction direction, const Rows& source, int from, int to, bool new_stage);
  bool Prune(const Rows& completions, int cluster, double most_sum, Budget& budget);
  void DropDead(int position, int cluster);
  void DropDominated();
  Origin FindOrigin(int position, int cluster, int row, int state) const;

  const StageModel& model_;
  std::vector<int> stage_at_;        // [position]
  std::vector<double> multipliers_;  // [cluster]
  double multiplier_sum_ = 0;
  std::vector<std::vector<double>> finish_;  // [cluster - first of the last stage][state]
  std::vector<Memory> remembered_;           // [cluster]
  std::vector<Memory> before_;               // [cluster]
  std::vector<Memory> after_;                // [cluster]

  // [position][cluster - first of its stage]: whether each state is alive; empty if none is.
  std::vector<std::vector<std::vector<char>>> alive_;

  Table forward_;
  Table backward_;
  std::array<bool, 2> complete_{};  // [direction] whether its table fits multipliers and finish
  double operations_ = 0;

  // Scratch of one cell.
  MemoryRowsBuilder<kWords> target_;
  MemoryRowsBuilder<kWords> grouped_;
  std::vector<double> completion_;
};

extern template class WalkDp<1>;
extern template class WalkDp<2>;
extern template class WalkDp<4>;
extern template class WalkDp<8>;

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_WALK_DP_H_
