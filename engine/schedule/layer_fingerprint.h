// Numbers that equal layers share, by which layers are recognised as the same problem.

#ifndef TRAVERSE_ENGINE_SCHEDULE_LAYER_FINGERPRINT_H_
#define TRAVERSE_ENGINE_SCHEDULE_LAYER_FINGERPRINT_H_

#include <cstdint>
#include <optional>

#include "engine/base/budget.h"
#include "engine/model/cost_spec.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/walls.h"

namespace traverse {

// Equal for plans with equal walls and the same cost; hardly ever equal for others.
struct LayerFingerprint {
  // Equal at any position: points are relative to the first one, within 1e-4 mm.
  uint64_t shape = 0;

  // Equal only at exactly the same position.
  uint64_t exact = 0;
};

// Asks `budget` regularly, if it is not null. O(points).
LayerFingerprint FingerprintOf(const Plan& plan, const CostSpec& cost, const LayerWalls& walls = {},
                               Budget* budget = nullptr);

// Layers of one shape with the same start, and the same finish if they have one, are the same
// problem, perhaps shifted. Positions are relative to the layer's origin, within 1e-4 mm.
uint64_t ProblemKey(uint64_t shape, Point origin, Point start, const std::optional<Point>& finish);

// The key of the same problem before a next layer with this shape, position and finish.
uint64_t ProblemKeyBefore(uint64_t key, Point origin, uint64_t next_shape, Point next_origin,
                          const std::optional<Point>& next_finish);

// The first point of the first path, to which the positions of a plan are relative; (0, 0) if there
// is none.
Point PlanOrigin(const Plan& plan);
inline Point RelativeTo(Point origin, Point p) { return {p.x - origin.x, p.y - origin.y}; }

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_FINGERPRINT_H_
