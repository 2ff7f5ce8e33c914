// The walls of a layer: what travel moves should not cross.

#ifndef TRAVERSE_ENGINE_MODEL_WALLS_H_
#define TRAVERSE_ENGINE_MODEL_WALLS_H_

#include <cstddef>
#include <vector>

#include "absl/status/status.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"

namespace traverse {

// A polyline.
struct Wall {
  std::vector<Point> points;  // at least two
  bool closed = false;        // the last point is joined to the first

  // Index into Plan::paths of the path whose outline it is; -1: of none, or nobody said.
  int path = -1;
};

// They count where CostSpec::kind is kTime; CostSpec has the prices.
struct LayerWalls {
  std::vector<Wall> walls;

  // Indices into Plan::paths. A move that begins or ends at one of their points is retracted beyond
  // a threshold of its own, for on them strings would be seen.
  std::vector<int> exposed;

  bool empty() const { return walls.empty() && exposed.empty(); }
};

// Checks what the comments above state, and that coordinates are finite and in range.
// InvalidArgument names the place, as in `walls[3].points[7].x: not finite`. O(points). `budget`,
// if there is one, is asked meanwhile.
absl::Status CheckWalls(const LayerWalls& walls, const Plan& plan, Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_WALLS_H_
