// The walls of a layer, which travel should not cross.

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

  // Index into Plan::paths of the path whose outline the wall is; -1: none, or unknown.
  int path = -1;
};

// A move with a cost of its own, from the given end of one path to the given beginning of
// another.
struct KnownMove {
  int from = 0;  // indices into Plan::paths
  int to = 0;
  double seconds = 0;  // without the price of a crossing
  bool crosses = false;
  bool retracts = false;
};

// Walls count if CostSpec::kind is kTime; CostSpec has the prices.
struct LayerWalls {
  std::vector<Wall> walls;

  // Indices into Plan::paths. A move that begins or ends at one of their points retracts beyond a
  // threshold of its own, because strings would be visible there.
  std::vector<int> exposed = {};

  // Indices into Plan::paths. After these the printer retracts in any case. So a retraction for a
  // wall or an exposed path costs half at one of their points, and nothing between two of them.
  std::vector<int> retracted = {};

  // At most as many as there are paths. Of several between the same points the first counts.
  std::vector<KnownMove> known = {};

  bool empty() const {
    return walls.empty() && exposed.empty() && retracted.empty() && known.empty();
  }
};

// Checks what the comments above state, and that coordinates are finite and in range.
// InvalidArgument names the position, as in `walls[3].points[7].x: not finite`. Asks `budget`
// regularly, if it is not null. O(points).
absl::Status CheckWalls(const LayerWalls& walls, const Plan& plan, Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_WALLS_H_
