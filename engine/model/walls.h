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

// A move that is done in another way than others are, from the end of one path, as it is given, to
// the beginning of another one.
struct KnownMove {
  int from = 0;  // indices into Plan::paths
  int to = 0;
  double seconds = 0;  // without the price of a crossing
  bool crosses = false;
  bool retracts = false;
};

// They count where CostSpec::kind is kTime; CostSpec has the prices.
struct LayerWalls {
  std::vector<Wall> walls;

  // Indices into Plan::paths. A move that begins or ends at one of their points is retracted beyond
  // a threshold of its own, for on them strings would be seen.
  std::vector<int> exposed = {};

  // Indices into Plan::paths. Behind them filament is pulled back in any case: a retraction for a
  // wall or an exposed path costs half at one of their points, and nothing between two of them.
  std::vector<int> retracted = {};

  // Of several between the same points the first counts. No more than there are paths.
  std::vector<KnownMove> known = {};

  bool empty() const {
    return walls.empty() && exposed.empty() && retracted.empty() && known.empty();
  }
};

// Checks what the comments above state, and that coordinates are finite and in range.
// InvalidArgument names the place, as in `walls[3].points[7].x: not finite`. O(points). `budget`,
// if there is one, is asked meanwhile.
absl::Status CheckWalls(const LayerWalls& walls, const Plan& plan, Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_WALLS_H_
