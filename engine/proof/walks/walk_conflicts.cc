#include "engine/proof/walks/walk_conflicts.h"

#include <algorithm>
#include <cstddef>

namespace traverse {

std::vector<WalkConflict> ConflictsOf(const StageModel& model,
                                      const std::vector<ClusterState>& walk) {
  std::vector<WalkConflict> conflicts;
  for (size_t j = 0; j < walk.size(); ++j) {
    const int at = walk[j].cluster;
    const std::vector<int>& after = model.After(at);
    for (size_t i = j; i-- > 0;) {
      const int earlier = walk[i].cluster;
      if (model.stage_of(earlier) != model.stage_of(at)) break;
      if (earlier != at && std::find(after.begin(), after.end(), earlier) == after.end()) continue;
      WalkConflict& conflict = conflicts.emplace_back();
      conflict.remembered = earlier;
      for (size_t k = i + 1; k < j; ++k) conflict.between.push_back(walk[k].cluster);
      break;
    }
  }
  return conflicts;
}

}  // namespace traverse
