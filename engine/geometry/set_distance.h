// The least distance between two sets of points.

#ifndef TRAVERSE_ENGINE_GEOMETRY_SET_DISTANCE_H_
#define TRAVERSE_ENGINE_GEOMETRY_SET_DISTANCE_H_

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/point.h"

namespace traverse {

// Between a point of `a` and one of `b`, in mm. O(n log n) for large sets on the average; small
// ones are compared pair by pair. Asks the budget, and returns that of the sets' boxes, which is no
// greater, once it is exhausted. REQUIRES: neither is empty.
double LeastDistance(absl::Span<const Point> a, absl::Span<const Point> b, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_SET_DISTANCE_H_
