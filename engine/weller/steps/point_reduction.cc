#include "engine/weller/steps/point_reduction.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "engine/geometry/bounding_box.h"

namespace traverse {
namespace {

const Path& PathOf(const Plan& plan, int path) { return plan.paths[static_cast<size_t>(path)]; }

int NearestVertex(const Path& contour, const std::vector<int>& vertices, Point to) {
  return *std::min_element(vertices.begin(), vertices.end(), [&](int i, int j) {
    return Distance(contour.points[static_cast<size_t>(i)], to) <
           Distance(contour.points[static_cast<size_t>(j)], to);
  });
}

}  // namespace

IslandAnalysis AnalyzeIslands(const IslandLayout& layout, const std::vector<int>& contours) {
  std::vector<bool> has_inner(layout.islands.size());
  const auto island_of = [&](int path) {
    return static_cast<size_t>(layout.island_of[static_cast<size_t>(path)]);
  };
  for (const int path : contours) {
    if (layout.islands[island_of(path)].outer != path) has_inner[island_of(path)] = true;
  }
  IslandAnalysis analysis;
  for (const int path : contours) {
    const bool outer = layout.islands[island_of(path)].outer == path;
    (outer && has_inner[island_of(path)] ? analysis.suppressed : analysis.kept).push_back(path);
  }
  return analysis;
}

std::vector<int> EntryVertices(const Path& contour) {
  if (!contour.allowed.empty()) return contour.allowed;
  std::vector<int> vertices(contour.points.size());
  std::iota(vertices.begin(), vertices.end(), 0);
  return vertices;
}

std::vector<int> SpacedPoints(const Path& contour, double spacing_mm) {
  std::vector<int> kept;
  for (const int vertex : EntryVertices(contour)) {
    const Point point = contour.points[static_cast<size_t>(vertex)];
    if (kept.empty() ||
        Distance(contour.points[static_cast<size_t>(kept.back())], point) >= spacing_mm) {
      kept.push_back(vertex);
    }
  }
  return kept;
}

std::vector<int> NearRasterPoints(const Plan& plan, const IslandLayout& layout, int contour,
                                  double spacing_mm) {
  const Path& path = PathOf(plan, contour);
  const int island = layout.island_of[static_cast<size_t>(contour)];
  const std::vector<int>& rasters = layout.islands[static_cast<size_t>(island)].rasters;
  if (rasters.empty()) return SpacedPoints(path, spacing_mm);
  const std::vector<int> vertices = EntryVertices(path);
  std::vector<int> near;
  near.reserve(2 * rasters.size());
  for (const int raster : rasters) {
    for (const Point& end : PathOf(plan, raster).points) {
      near.push_back(NearestVertex(path, vertices, end));
    }
  }
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  return near;
}

Point BoxCenterPoint(const Path& contour) {
  return BoundingBox(PointsAt(contour, EntryVertices(contour))).center();
}

std::vector<Point> RepresentativePoints(const Plan& plan, const IslandLayout& layout, int contour,
                                        Representation representation, double spacing_mm) {
  const Path& path = PathOf(plan, contour);
  switch (representation) {
    case Representation::kSpacedPoints:
      return PointsAt(path, SpacedPoints(path, spacing_mm));
    case Representation::kNearRasterPoints:
      return PointsAt(path, NearRasterPoints(plan, layout, contour, spacing_mm));
    case Representation::kBoxCenter:
      break;
  }
  return {BoxCenterPoint(path)};
}

std::vector<Point> PointsAt(const Path& path, const std::vector<int>& vertices) {
  std::vector<Point> points;
  points.reserve(vertices.size());
  for (const int vertex : vertices) points.push_back(path.points[static_cast<size_t>(vertex)]);
  return points;
}

}  // namespace traverse
