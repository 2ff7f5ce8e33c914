// The visibility polygon of two contours: the area between their outer tangents.
//
//        a1 o------------------o b1       the tangents touch a in a1 and a2, b in b1 and b2;
//         / .\                /. \        the polygon is a1, a2, b2, b1
//        | a  |    polygon   |  b |
//         \ ./                \. /
//        a2 o------------------o b2
//
// Source: thesis 3.2, step 3 (p. 66-67) and figure 3.8, after Joe and Simpson (1987).

#ifndef TRAVERSE_ENGINE_GEOMETRY_VISIBILITY_POLYGON_H_
#define TRAVERSE_ENGINE_GEOMETRY_VISIBILITY_POLYGON_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/model/point.h"

namespace traverse {

// The points of two contours in their visibility polygon or on its border: indices in rising order,
// at least one for each contour.
struct VisiblePoints {
  std::vector<int> a;
  std::vector<int> b;
};

// A single point, such as the origin, is a contour too. Unset if there is no polygon because the
// convex hulls overlap: one contour encloses the other, or they interlock. REQUIRES: neither is
// empty. O(n log n).
std::optional<VisiblePoints> FindVisiblePoints(absl::Span<const Point> a,
                                               absl::Span<const Point> b);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_VISIBILITY_POLYGON_H_
