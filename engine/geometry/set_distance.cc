#include "engine/geometry/set_distance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/base/rest.h"
#include "engine/geometry/bounding_box.h"
#include "engine/geometry/nearest_point_index.h"

namespace traverse {
namespace {

// From this many pairs on an index is faster.
constexpr size_t kPairsForIndex = 1 << 15;

double SquaredDistance(Point p, Point q) {
  const double dx = p.x - q.x;
  const double dy = p.y - q.y;
  return dx * dx + dy * dy;
}

}  // namespace

double LeastDistance(absl::Span<const Point> a, absl::Span<const Point> b, Budget& budget) {
  assert(!a.empty() && !b.empty());
  double least = std::numeric_limits<double>::infinity();
  if (a.size() * b.size() <= kPairsForIndex) {
    for (const Point& p : a) {
      for (const Point& q : b) least = std::min(least, SquaredDistance(p, q));
    }
    return std::sqrt(least);
  }
  if (a.size() < b.size()) std::swap(a, b);
  const NearestPointIndex index({a.begin(), a.end()}, &budget);
  for (const Point& p : b) {
    if (budget.Exhausted()) return BoundingBox(a).DistanceTo(BoundingBox(b));
    least = std::min(least, index.SquaredDistance(index.Nearest(p), p));
  }
  return std::sqrt(least);
}

}  // namespace traverse
