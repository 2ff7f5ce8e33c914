// Proves a route of a stage model optimal, or bounds how much better one can be: whichever methods
// suit its stages, together.
//
// Walks with memory (walk_prover.h) suit clusters with many states, branch and cut (path_tsp.h)
// items with two ends. Where the last stage is of the second kind, the two meet in the states at
// which that stage is begun, as the L-shaped method has it (Van Slyke and Wets 1969): with
//
//   F(v)   least cost of the stages before, ending in state v
//   d(v,e) cost of the move from v to state e of the last stage
//   H(e)   least cost of the last stage begun in e
//
// the optimum is the least of F(v) + d(v,e) + H(e). A lower bound h of H is the finish of the
// walks; lower bounds f of F(v) + d(v,e) are start costs of the branch and cut; its least cost w
// shows that H(e) >= w - f(e) for all e, which makes h better. Each round ends with a proof, with a
// better route, or with an h that is exact for one state more.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_STAGE_PROOF_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_STAGE_PROOF_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/walks/stage_model.h"
#include "engine/proof/walks/walk_prover.h"

namespace traverse {

struct StageProofOptions {
  WalkProver::Options walks;
  int least_items_to_branch = 8;  // walks solve smaller last stages
};

struct StageProof {
  std::vector<ClusterState> walk;  // the best route: the given one or a better one
  double cost = 0;                 // of the best route
  double lower_bound = 0;          // of any route, to a relative 1e-9
  bool proven = false;             // lower_bound equals cost

  // The effort it took.
  int passes = 0;  // of dynamic programming
  int nodes = 0;   // of branch and cut
  int cuts = 0;
};

// Starts from `walk`, a route. REQUIRES: the model has a cluster. Deterministic unless the budget
// ends it.
StageProof ProveByStages(const StageModel& model, const std::vector<ClusterState>& walk,
                         const StageProofOptions& options, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_STAGE_PROOF_H_
