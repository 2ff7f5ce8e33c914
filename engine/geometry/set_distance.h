// The least distance between two sets of points.

#ifndef TRAVERSE_ENGINE_GEOMETRY_SET_DISTANCE_H_
#define TRAVERSE_ENGINE_GEOMETRY_SET_DISTANCE_H_

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/point.h"

namespace traverse {

// The least distance between a point of `a` and one of `b`, in mm. Large sets take O(n log n) on
// average; small ones are compared pair by pair. Once the budget is exhausted, returns the distance
// of the sets' boxes, which is no greater. REQUIRES: neither set is empty.
double LeastDistance(absl::Span<const Point> a, absl::Span<const Point> b, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_SET_DISTANCE_H_
