// What makes two layers the same problem: numbers that equal layers share.

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

// Numbers that equal plans with equal walls and the same cost share; different ones hardly ever do.
struct LayerFingerprint {
  // Equal wherever they are: points are relative to the first one, to 1e-4 mm.
  uint64_t shape = 0;

  // Equal, and at the very same place.
  uint64_t exact = 0;
};

// O(points); asks `budget`, if there is one, meanwhile.
LayerFingerprint FingerprintOf(const Plan& plan, const CostSpec& cost, const LayerWalls& walls = {},
                               Budget* budget = nullptr);

// Layers of one shape with the same start, and finish if they have one, are the same problem moved
// along. Places are relative to the layer's origin, to 1e-4 mm.
uint64_t ProblemKey(uint64_t shape, Point origin, Point start, const std::optional<Point>& finish);

// The same problem before a next layer of the same shape, position and finish.
uint64_t ProblemKeyBefore(uint64_t key, Point origin, uint64_t next_shape, Point next_origin,
                          const std::optional<Point>& next_finish);

// The first point of the first path, from which the places of a plan are told; 0, 0 if there is
// none.
Point PlanOrigin(const Plan& plan);
inline Point RelativeTo(Point origin, Point p) { return {p.x - origin.x, p.y - origin.y}; }

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SCHEDULE_LAYER_FINGERPRINT_H_
