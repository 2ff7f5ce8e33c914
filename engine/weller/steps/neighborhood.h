// Step 2 of the framework, first part: which contours may follow each other.
//
//      . - .         A circle around the center of each contour's bounding box grows until it
//    '  B    '       meets two other contours. A is then a neighbor of both, and they of A.
//   .   ( A )  C     Groups that stay unconnected are linked where they are nearest.
//    '   D   '
//      ' - '
//
// Source: thesis 3.2, step 2 (p. 63-65), figure 3.7, after Arya et al. (1998); clusters after
// Saxena et al. (2017); SPEC 3.5.

#ifndef TRAVERSE_ENGINE_WELLER_STEPS_NEIGHBORHOOD_H_
#define TRAVERSE_ENGINE_WELLER_STEPS_NEIGHBORHOOD_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/base/symmetric_relation.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/weller/steps/island_layout.h"

namespace traverse {

// Node i is a contour (the header of each function says which), the last node the origin.
using Neighborhood = SymmetricRelation;

// A contour with the circle around it, and the points that other circles meet.
struct CircledContour {
  std::vector<Point> points;  // spaced points (SP) of the contour; for the origin only itself
  Point center;               // of its bounding box (BBCP)
  double shorter_side_mm = 0;
};

struct NeighborhoodOptions {
  int neighbors = 2;           // that a circle has to meet before it stops growing
  double first_radius_mm = 0;  // 0: the shorter side of the contour's own bounding box
  double step_mm = 5;          // by which it grows, > 0
};

// The circle of a contour. `spacing_mm` is that of SP.
CircledContour CircleOf(const Path& contour, double spacing_mm);

// The circles' neighbors: node i is contours[i], the last node is `origin`. A circle meets a
// contour if a spaced point lies in it. It never meets the origin, but the origin has a circle of
// its own. It stops at the first radius, in steps, at which it meets enough contours (all that it
// then meets are neighbors), or when it reaches the farthest corner of the box around everything,
// because the engine knows no build envelope. Reciprocal. Components are not linked yet. Incomplete
// if the budget ends. About O(contours^2 + contours x points of the near ones).
Neighborhood GrowCircles(const std::vector<CircledContour>& contours, Point origin,
                         const NeighborhoodOptions& options, Budget& budget);

// Links the components: for each two of them, the two nearest spaced points make their contours
// neighbors (single linkage), as line 8a on p. 64 says, "for all clusters there are". With a tree
// of only the shortest links, three clusters in a row would have no sequence except ones that end
// in the middle. More than 200 components get the tree. Incomplete if the budget ends. `contours`
// and `origin` as in GrowCircles.
void LinkClusters(const std::vector<CircledContour>& contours, Point origin,
                  Neighborhood& neighborhood, Budget& budget);

// Step 4, p. 67: the neighborhood of step 2 between islands. Node i is island i of `layout`; two
// are neighbors if any of their contours are. `contours[i]` is the path of node i of
// `neighborhood`.
Neighborhood IslandNeighborhood(const IslandLayout& layout, const std::vector<int>& contours,
                                const Neighborhood& neighborhood);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_STEPS_NEIGHBORHOOD_H_
