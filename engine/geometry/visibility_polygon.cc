#include "engine/geometry/visibility_polygon.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <optional>

#include "engine/geometry/convex_hull.h"

namespace traverse {
namespace {

// Rounding of an area in mm^2, for coordinates of about 100 mm; otherwise relative to the square of
// a length.
constexpr double kAreaTolerance = 1e-9;
constexpr double kAreaRounding = 1e-15;

// The line between the points where the tangents touch one contour; the other contour is to its
// left.
struct Chord {
  Point tail;
  Point head;
  bool HasOnItsLeft(Point point) const {
    const double area = Cross(tail, head, point);
    if (area >= -kAreaTolerance) return true;
    return area >= -kAreaRounding * Distance(tail, head) * Distance(tail, point);
  }
};

bool AllOnLeft(absl::Span<const Point> points, const Chord& chord) {
  return std::all_of(points.begin(), points.end(),
                     [&](Point point) { return chord.HasOnItsLeft(point); });
}

// Indices of the points on the chord or to its left. The tangents bound the rest: every point lies
// between them already.
std::vector<int> OnLeft(absl::Span<const Point> points, const Chord& chord) {
  std::vector<int> kept;
  for (size_t i = 0; i < points.size(); ++i) {
    if (chord.HasOnItsLeft(points[i])) kept.push_back(static_cast<int>(i));
  }
  return kept;
}

}  // namespace

std::optional<VisiblePoints> FindVisiblePoints(absl::Span<const Point> a,
                                               absl::Span<const Point> b) {
  assert(!a.empty() && !b.empty());
  const std::optional<OuterTangents> tangents = FindOuterTangents(a, b);
  if (!tangents) return std::nullopt;
  const auto at = [](absl::Span<const Point> points, int i) {
    return points[static_cast<size_t>(i)];
  };
  const Chord a_chord{at(a, tangents->a_left), at(a, tangents->a_right)};
  const Chord b_chord{at(b, tangents->b_right), at(b, tangents->b_left)};
  // A contour reaches beyond the other one's chord only if their hulls overlap.
  if (!AllOnLeft(a, b_chord) || !AllOnLeft(b, a_chord)) return std::nullopt;
  return VisiblePoints{OnLeft(a, a_chord), OnLeft(b, b_chord)};
}

}  // namespace traverse
