// Where a walk is no route.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_WALK_CONFLICTS_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_WALK_CONFLICTS_H_

#include <vector>

#include "engine/proof/walks/stage_model.h"

namespace traverse {

// Two visits that no route has in this order: to the same cluster, or to one that must come after
// the other. They cannot both be made once all clusters visited in between remember the first.
struct WalkConflict {
  int remembered = 0;        // the cluster visited first
  std::vector<int> between;  // clusters, in the order of their visits
};

// For each visit the closest earlier one that it is in conflict with. Empty if the walk is a route.
// `walk` has the right number of visits in each stage.
std::vector<WalkConflict> ConflictsOf(const StageModel& model,
                                      const std::vector<ClusterState>& walk);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_WALK_CONFLICTS_H_
