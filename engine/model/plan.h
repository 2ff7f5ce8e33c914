// A plan: a layer's paths and the orders in which they may be done.

#ifndef TRAVERSE_ENGINE_MODEL_PLAN_H_
#define TRAVERSE_ENGINE_MODEL_PLAN_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "engine/model/path.h"

namespace traverse {

class Budget;

// One node of a plan's tree.
struct PlanNode {
  enum class Kind {
    kPath,      // a leaf
    kInOrder,   // children in the given order
    kAnyOrder,  // children in any order that keeps `before`, each done completely before
                // the next starts
  };

  Kind kind = Kind::kPath;

  // kPath: index into Plan::paths.
  int path = 0;

  // Otherwise: indices into Plan::nodes, each greater than this node's own.
  std::vector<int> children;

  // kAnyOrder: pairs (i, j) of positions in `children`; child i comes before child j.
  std::vector<std::pair<int, int>> before;
};

// A tree stored flat: nodes[0] is the root; every other node is the child of exactly one node of
// smaller index; every path is the leaf of exactly one node. An empty layer has neither nodes nor
// paths.
struct Plan {
  std::vector<Path> paths;
  std::vector<PlanNode> nodes;
};

// Deepest tree accepted, in levels of nodes. Algorithms may recurse over a plan.
inline constexpr int kMaxPlanDepth = 100;

// Checks everything that the comments above state, that coordinates are finite and within
// kMaxCoordinateMm, and that no `before` has a cycle. InvalidArgument says where, as in
// `nodes[3].before[2].first: 7 is not the position of a child` or `paths[0].points[7].x: not
// finite`. Algorithms rely on this check. Asks `budget` regularly, if it is not null, as do the
// functions below; always finishes. O(nodes + paths + points + pairs).
absl::Status CheckPlan(const Plan& plan, Budget* budget = nullptr);

// Says why `coordinate` (mm) is invalid, as "not finite" or "beyond 1e+06 mm"; null if it is valid.
const char* CoordinateFault(double coordinate);

// The contours and rasters of one island, for the plan builders below. The first contour is the
// outer one. Either list may be empty. The builders set Path::island and Path::outer.
struct IslandPaths {
  std::vector<Path> contours;
  std::vector<Path> rasters;
};

// in_order(any_order(all contours), any_order(all rasters)): SPEC section 1, sequential deposition.
// Plan::paths holds island by island its contours, then its rasters.
Plan SequentialPlan(std::vector<IslandPaths> islands, Budget* budget = nullptr);

// any_order over islands of in_order(outer contour, any_order(inner contours), any_order(rasters)):
// SPEC section 1, interleaved deposition. Plan::paths as above.
Plan InterleavedPlan(std::vector<IslandPaths> islands, Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_PLAN_H_
