// Lower bounds and best routes of the first stages of a model, by walks with memory.
//
// The lowest walk (walk_dp.h) bounds every route. Where it visits a cluster twice, that cluster's
// multiplier grows, where it leaves one out, it shrinks (multiplier_search.h). When that gains
// little, clusters between two visits of one cluster are made to remember it (dynamic ng-routes:
// Roberti and Mingozzi 2014). Whenever the gap has become smaller, what cannot be part of a better
// route is dropped for good, so passes get cheaper as the bound gets better. It ends when a lowest
// walk is a route, or costs as much as the best route known.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_WALK_PROVER_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_WALK_PROVER_H_

#include <memory>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/walks/stage_model.h"

namespace traverse {

class WalkProver {
 public:
  struct Options {
    int first_memory = 5;          // clusters that each one remembers at first, including itself
    double most_operations = 4e9;  // multiply-adds of one pass; memory grows with it
  };

  enum class Outcome {
    kRoute,    // lowest() is a route: none costs less
    kNothing,  // no route costs less than the limit
    kPasses,   // the passes are used up
    kStopped,  // the budget ran out, or a pass became too big
  };

  // For stages [0, stages) of `model`, which outlives this. If the budget ends meanwhile, the first
  // memory is smaller than asked for. REQUIRES: stages >= 1.
  static std::unique_ptr<WalkProver> Make(const StageModel& model, int stages,
                                          const Options& options, Budget& budget);

  virtual ~WalkProver() = default;

  // Costs of all that follows the last of the stages: [cluster - first of that stage][state]. At
  // first the model's costs, or 0 if stages follow. REQUIRES: no cost is less than before.
  virtual void SetFinish(std::vector<std::vector<double>> finish) = 0;

  // Improves the bound for at most `most_passes`. REQUIRES: `limit` is not more than before.
  virtual Outcome Run(double limit, int most_passes, Budget& budget) = 0;

  // No route costs less than the smaller of this and the last limit. Holds for later finishes too.
  virtual double lower_bound() const = 0;

  // The lowest walk of the last pass.
  virtual const std::vector<ClusterState>& lowest() const = 0;

  // For each state of each cluster of the last stage: no route that ends there and survives the
  // last limit costs less without the finish. Empty if the budget runs out.
  virtual std::vector<std::vector<double>> EndBounds(Budget& budget) = 0;

  virtual int passes() const = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_WALK_PROVER_H_
