// Step 1 of the framework: fewer points.
//
//   contours     o-o-o-o-o-o      all vertices, or Path::allowed
//   SP           o-----o-----o    at least Dp apart
//   NRP          o-----------o    next to the ends of the island's rasters
//   BBCP               +          the center of the bounding box
//
// Source: thesis 3.2, step 1 (p. 59-63), figures 3.5 and 3.6; SPEC 3.5.

#ifndef TRAVERSE_ENGINE_WELLER_STEPS_POINT_REDUCTION_H_
#define TRAVERSE_ENGINE_WELLER_STEPS_POINT_REDUCTION_H_

#include <vector>

#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/weller/steps/island_layout.h"

namespace traverse {

// How a contour is represented in step 2.
enum class Representation { kSpacedPoints, kNearRasterPoints, kBoxCenter };

// The contours that step 2 arranges. Indices into Plan::paths.
struct IslandAnalysis {
  std::vector<int> kept;  // in the order of `contours`
  std::vector<int>
      suppressed;  // outer contours of islands with inner ones; step 3 brings them back
};

// Step 1 (b), island analysis, p. 60: the inner contours of an island represent it alone, because
// the head must cross the outer one to reach them. `contours` are those to arrange; an island whose
// inner contours are not among them keeps its outer one. O(contours).
IslandAnalysis AnalyzeIslands(const IslandLayout& layout, const std::vector<int>& contours);

// The vertices at which `contour` may be entered: Path::allowed, or all of them.
std::vector<int> EntryVertices(const Path& contour);

// Step 1 (c), spaced points (SP), p. 61: walks along the entry vertices and drops those that are
// nearer than `spacing_mm` (Dp) to the last one kept; always keeps the first. Indices of vertices
// in the order of EntryVertices. O(vertices).
std::vector<int> SpacedPoints(const Path& contour, double spacing_mm);

// Step 1 (d), near raster points (NRP), p. 62: for each end of each raster of the contour's
// island, the nearest entry vertex of `contour` (the first of equally near ones). Indices of
// vertices, rising, each once. For an island without rasters, the spaced points. O(vertices x
// rasters).
std::vector<int> NearRasterPoints(const Plan& plan, const IslandLayout& layout, int contour,
                                  double spacing_mm);

// Step 1 (e), bounding box center point (BBCP), p. 62, of the entry vertices. O(vertices).
Point BoxCenterPoint(const Path& contour);

// The points that represent `contour` (index into Plan::paths) in step 2: at least one.
std::vector<Point> RepresentativePoints(const Plan& plan, const IslandLayout& layout, int contour,
                                        Representation representation, double spacing_mm);

// The points of `path` at `vertices`.
std::vector<Point> PointsAt(const Path& path, const std::vector<int>& vertices);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_WELLER_STEPS_POINT_REDUCTION_H_
