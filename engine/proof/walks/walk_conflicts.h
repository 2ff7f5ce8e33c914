// Where a walk fails to be a route.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_WALK_CONFLICTS_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_WALK_CONFLICTS_H_

#include <vector>

#include "engine/proof/walks/stage_model.h"

namespace traverse {

// Two visits that no route makes in this order: to the same cluster, or to one that must come after
// the other. A walk cannot make both once all clusters visited in between remember the first.
struct WalkConflict {
  int remembered = 0;        // the cluster visited first
  std::vector<int> between;  // clusters, in the order of their visits
};

// For each visit the closest earlier one that conflicts with it. Empty if the walk is a route.
// `walk` has the right number of visits in each stage.
std::vector<WalkConflict> ConflictsOf(const StageModel& model,
                                      const std::vector<ClusterState>& walk);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_WALK_CONFLICTS_H_
