#include "engine/framework/contour_route.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "engine/framework/point_reduction.h"
#include "engine/geometry/visibility_polygon.h"

namespace traverse {
namespace {

const Path& PathOf(const Plan& plan, int path) { return plan.paths[static_cast<size_t>(path)]; }

// What going by way of the best of `points` adds to the move `from` -> `to`.
double DetourCost(const std::vector<Point>& points, Point from, Point to, const TravelCost& cost) {
  double least = std::numeric_limits<double>::infinity();
  for (const Point& point : points) least = std::min(least, cost(from, point) + cost(point, to));
  return least - cost(from, to);
}

// Adds those of `vertices` that `visible` lists.
void Mark(const std::vector<int>& visible, std::vector<bool>& marked) {
  for (const int index : visible) marked[static_cast<size_t>(index)] = true;
}

}  // namespace

std::vector<int> ReinsertOuterContours(const Plan& plan, const IslandLayout& layout,
                                       const std::vector<int>& suppressed,
                                       const std::vector<SequencedContour>& sequence, Point start,
                                       const TravelCost& cost, double spacing_mm) {
  const auto island_at = [&](size_t position) {
    return layout.island_of[static_cast<size_t>(sequence[position].path)];
  };
  std::vector<int> outer_of(layout.islands.size(), -1);  // [island] its suppressed contour
  for (const int outer : suppressed) {
    outer_of[static_cast<size_t>(layout.island_of[static_cast<size_t>(outer)])] = outer;
  }
  std::vector<double> least(layout.islands.size(), std::numeric_limits<double>::infinity());
  std::vector<int> at(layout.islands.size(), -1);  // [island] position that its outer one precedes
  for (size_t k = 0; k < sequence.size(); ++k) {
    const size_t island = static_cast<size_t>(island_at(k));
    if (outer_of[island] < 0 || (k > 0 && island_at(k - 1) == island_at(k))) continue;
    const Path& outer = PathOf(plan, outer_of[island]);
    const double detour =
        DetourCost(PointsAt(outer, SpacedPoints(outer, spacing_mm)),
                   k > 0 ? sequence[k - 1].point : start, sequence[k].point, cost);
    if (detour >= least[island]) continue;
    least[island] = detour;
    at[island] = static_cast<int>(k);
  }
  std::vector<int> order;
  order.reserve(sequence.size() + suppressed.size());
  for (size_t k = 0; k < sequence.size(); ++k) {
    const size_t island = static_cast<size_t>(island_at(k));
    if (at[island] == static_cast<int>(k)) order.push_back(outer_of[island]);
    order.push_back(sequence[k].path);
  }
  return order;
}

std::vector<std::vector<int>> VisiblePointsAlong(const Plan& plan, const std::vector<int>& order,
                                                 Point start, double spacing_mm) {
  std::vector<std::vector<int>> visible(order.size());
  std::vector<int> vertices;         // spaced points of order[k]
  std::vector<Point> before{start};  // the points that the polygon before order[k] starts from
  std::vector<bool> marked{false};   // [index into the spaced points of order[k]]
  for (size_t k = 0; k < order.size(); ++k) {
    const Path& path = PathOf(plan, order[k]);
    std::vector<int> next_vertices = SpacedPoints(path, spacing_mm);
    std::vector<Point> next = PointsAt(path, next_vertices);
    const VisiblePoints pair = FindVisiblePoints(before, next);
    Mark(pair.a, marked);
    for (size_t i = 0; i < vertices.size(); ++i) {
      if (marked[i]) visible[k - 1].push_back(vertices[i]);
    }
    marked.assign(next.size(), false);
    Mark(pair.b, marked);
    vertices = std::move(next_vertices);
    before = std::move(next);
  }
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (marked[i]) visible.back().push_back(vertices[i]);
  }
  for (std::vector<int>& set : visible) std::sort(set.begin(), set.end());
  return visible;
}

Route ChooseContourPoints(const Plan& plan, const std::vector<int>& order,
                          const std::vector<std::vector<int>>& vertices, Point start,
                          const TravelCost& cost) {
  // come_from[k][i]: index into vertices[k - 1] of the best way to vertices[k][i].
  std::vector<std::vector<int>> come_from(order.size());
  std::vector<Point> layer{start};
  std::vector<double> reach{0};  // [i] least cost to layer[i]
  for (size_t k = 0; k < order.size(); ++k) {
    const std::vector<Point> next = PointsAt(PathOf(plan, order[k]), vertices[k]);
    std::vector<double> next_reach(next.size(), std::numeric_limits<double>::infinity());
    come_from[k].resize(next.size());
    for (size_t i = 0; i < next.size(); ++i) {
      for (size_t j = 0; j < layer.size(); ++j) {
        const double by_j = reach[j] + cost(layer[j], next[i]);
        if (by_j >= next_reach[i]) continue;
        next_reach[i] = by_j;
        come_from[k][i] = static_cast<int>(j);
      }
    }
    layer = next;
    reach = std::move(next_reach);
  }
  Route route(order.size());
  size_t i = static_cast<size_t>(std::min_element(reach.begin(), reach.end()) - reach.begin());
  for (size_t k = order.size(); k-- > 0;) {
    route[k] = Visit{order[k], vertices[k][i]};
    i = static_cast<size_t>(come_from[k][i]);
  }
  return route;
}

}  // namespace traverse
