#include "engine/weller/steps/contour_route.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>

#include "engine/base/rest.h"
#include "engine/cost/entry_choice.h"
#include "engine/cost/entry_table.h"
#include "engine/geometry/visibility_polygon.h"
#include "engine/weller/steps/point_reduction.h"

namespace traverse {
namespace {

const Path& PathOf(const Plan& plan, int path) { return plan.paths[static_cast<size_t>(path)]; }

// What going by way of the best of `points` adds to the move `from` -> `to`.
double DetourCost(const std::vector<Point>& points, Point from, Point to, const TravelCost& cost) {
  double least = std::numeric_limits<double>::infinity();
  for (const Point& point : points) least = std::min(least, cost(from, point) + cost(point, to));
  return least - cost(from, to);
}

// The spaced points of the contours of a sequence. The start is the first of them.
struct SpacedSequence {
  std::vector<std::vector<int>> vertices;
  std::vector<std::vector<Point>> points;
};

// Of each contour, which spaced points are in the polygon with what comes before it, and with what
// comes after.
struct Marks {
  std::vector<std::vector<bool>> before;
  std::vector<std::vector<bool>> after;
};

// Marks what contour k sees of contour `other`, the next or the next but one, and the other way
// round. False if there is no polygon between them.
bool MarkVisible(const SpacedSequence& sequence, size_t k, size_t other, bool mark_k,
                 bool mark_other, Marks& marks) {
  const auto visible = FindVisiblePoints(sequence.points[k], sequence.points[other]);
  if (!visible) return false;
  if (mark_k) {
    for (const int i : visible->a) marks.after[k][static_cast<size_t>(i)] = true;
  }
  if (mark_other) {
    for (const int i : visible->b) marks.before[other][static_cast<size_t>(i)] = true;
  }
  return true;
}

Marks MarkAlong(const SpacedSequence& sequence, Rest& rest) {
  const size_t count = sequence.points.size();
  Marks marks;
  for (const auto& points : sequence.points) marks.before.emplace_back(points.size());
  marks.after = marks.before;
  std::vector<bool> sees_next(count);
  for (size_t k = 0;
       k + 1 < count && rest(16 * (sequence.points[k].size() + sequence.points[k + 1].size()));
       ++k) {
    sees_next[k] = MarkVisible(sequence, k, k + 1, true, true, marks);
  }
  for (size_t k = 0;
       k + 2 < count && rest(16 * (sequence.points[k].size() + sequence.points[k + 2].size()));
       ++k) {
    if (sees_next[k] && sees_next[k + 1]) continue;
    MarkVisible(sequence, k, k + 2, !sees_next[k], !sees_next[k + 1], marks);
  }
  return marks;
}

bool Any(const std::vector<bool>& marks) {
  return std::find(marks.begin(), marks.end(), true) != marks.end();
}

// Of `before` and `after`: what is in both, if that is wanted and there is any, else in either;
// everything if nothing is in either.
std::vector<bool> Combine(const std::vector<bool>& before, const std::vector<bool>& after,
                          VisibleIn visible_in) {
  std::vector<bool> either(before.size());
  std::vector<bool> both(before.size());
  for (size_t i = 0; i < before.size(); ++i) {
    either[i] = before[i] || after[i];
    both[i] = before[i] && after[i];
  }
  if (visible_in == VisibleIn::kBothPolygons && Any(both)) return both;
  if (!Any(either)) either.assign(either.size(), true);
  return either;
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
  assert(order.size() == sequence.size() + suppressed.size());
  return order;
}

std::vector<std::vector<int>> VisiblePointsAlong(const Plan& plan, const std::vector<int>& order,
                                                 Point start, double spacing_mm,
                                                 VisibleIn visible_in, Budget* budget) {
  SpacedSequence sequence{{{0}}, {{start}}};
  Rest rest(budget);
  for (const int path : order) {
    rest(4 + 4 * PathOf(plan, path).points.size());
    sequence.vertices.push_back(SpacedPoints(PathOf(plan, path), spacing_mm));
    sequence.points.push_back(PointsAt(PathOf(plan, path), sequence.vertices.back()));
  }
  const Marks marks = MarkAlong(sequence, rest);
  std::vector<std::vector<int>> visible(order.size());
  for (size_t k = 1; k <= order.size(); ++k) {
    rest(4 + 4 * sequence.vertices[k].size());
    const std::vector<bool> marked = Combine(marks.before[k], marks.after[k], visible_in);
    for (size_t i = 0; i < marked.size(); ++i) {
      if (marked[i]) visible[k - 1].push_back(sequence.vertices[k][i]);
    }
    std::sort(visible[k - 1].begin(), visible[k - 1].end());
  }
  return visible;
}

Route ChooseContourPoints(const Plan& plan, const std::vector<int>& order,
                          const std::vector<std::vector<int>>& vertices, Point start,
                          const TravelCost& cost, Budget* budget) {
  Rest rest(budget);
  Plan reduced;  // path k is order[k] with its vertices[k] alone
  for (size_t k = 0; k < order.size(); ++k) {
    rest(8 + vertices[k].size());
    reduced.paths.push_back(MakeContour(PointsAt(PathOf(plan, order[k]), vertices[k])));
  }
  const EntryTable table(reduced, budget);
  std::vector<int> paths(order.size());
  std::iota(paths.begin(), paths.end(), 0);
  std::vector<int> entries(order.size());
  EntryChoice(table, cost, budget).Choose(start, paths, std::nullopt, absl::MakeSpan(entries));
  Route route;
  for (size_t k = 0; k < order.size(); ++k) {
    const int chosen = table.VisitOf(entries[k]).entry;
    route.push_back(Visit{order[k], vertices[k][static_cast<size_t>(chosen)]});
  }
  return route;
}

}  // namespace traverse
