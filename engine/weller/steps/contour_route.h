// Step 3 of the framework: from the preliminary sequence to a feasible route of the contours.
//
// Source: thesis 3.2, step 1 (b) and step 3 (p. 60, 66-67), figures 3.5 and 3.8; SPEC 3.5.

#ifndef TRAVERSE_ENGINE_WELLER_STEPS_CONTOUR_ROUTE_H_
#define TRAVERSE_ENGINE_WELLER_STEPS_CONTOUR_ROUTE_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/cost/travel_cost.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/route.h"
#include "engine/weller/steps/island_layout.h"

namespace traverse {

// A contour of the preliminary sequence, with the point that represented it in step 2.
struct SequencedContour {
  int path = 0;  // index into Plan::paths
  Point point;
};

// Re-inserts the outer contours that step 1 suppressed into `sequence`: each on a move that reaches
// its island from elsewhere (the head crosses the outer contour there); of several such moves the
// one where it costs least, through its best spaced point. Returns the paths in order. REQUIRES:
// `sequence` has a contour of the island of each of `suppressed`. O(points).
//
//   before    a ---------------> b (inner)           the move a -> b enters b's island
//   after     a ----> outer ---> b (inner)
std::vector<int> ReinsertOuterContours(const Plan& plan, const IslandLayout& layout,
                                       const std::vector<int>& suppressed,
                                       const std::vector<SequencedContour>& sequence, Point start,
                                       const TravelCost& cost, double spacing_mm);

// Which spaced points of a contour between two others are visible.
enum class VisibleIn {
  kEitherPolygon,  // a superset: the sets of both polygons
  kBothPolygons,   // if no point is in both, those in either; as many as thesis table 5.4 has
};

// For each contour of `order` (indices into Plan::paths), the spaced points that lie in a
// visibility polygon with the contour before (for the first one: with `start`) or after it, or in
// both. With a contour that it encloses, or that encloses it, there is no polygon, and the next but
// one takes its place:
//
//   a -> outer -> inner -> b      outer: with a and b; inner: with a and b
//
// If that has none either, all spaced points count. Indices of vertices, rising, at least one each.
// O(m log m) for m points. Asks `budget` regularly, if it is not null; once it is exhausted, all
// spaced points of the remaining contours count.
std::vector<std::vector<int>> VisiblePointsAlong(const Plan& plan, const std::vector<int>& order,
                                                 Point start, double spacing_mm,
                                                 VisibleIn visible_in = VisibleIn::kEitherPolygon,
                                                 Budget* budget = nullptr);

// The visits of `order` with the least cost from `start`, if contour order[k] may be entered only
// at vertices[k]: a shortest path in a layered graph, exact (equations 4.8-4.13 without a MILP).
// After the last contour the head goes nowhere. O(sum over k of |vertices[k]| |vertices[k + 1]|).
Route ChooseContourPoints(const Plan& plan, const std::vector<int>& order,
                          const std::vector<std::vector<int>>& vertices, Point start,
                          const TravelCost& cost, Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_STEPS_CONTOUR_ROUTE_H_
