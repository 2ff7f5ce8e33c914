#include "engine/geometry/convex_hull.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <numeric>

namespace traverse {
namespace {

// Appends the lower chain of `order`, which is sorted from left to right, without its last point.
// Sorted from right to left, it gives the upper chain.
template <typename Iterator>
void AppendChain(absl::Span<const Point> points, Iterator begin, Iterator end,
                 std::vector<int>& hull) {
  const size_t base = hull.size();
  const auto at = [&](int index) { return points[static_cast<size_t>(index)]; };
  for (Iterator next = begin; next != end; ++next) {
    while (hull.size() >= base + 2 &&
           Cross(at(hull[hull.size() - 2]), at(hull.back()), at(*next)) <= 0) {
      hull.pop_back();
    }
    hull.push_back(*next);
  }
  hull.pop_back();
}

}  // namespace

std::vector<int> ConvexHull(absl::Span<const Point> points) {
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&](int index) { return points[static_cast<size_t>(index)]; };
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    if (at(i).x != at(j).x) return at(i).x < at(j).x;
    if (at(i).y != at(j).y) return at(i).y < at(j).y;
    return i < j;
  });
  order.erase(std::unique(order.begin(), order.end(), [&](int i, int j) { return at(i) == at(j); }),
              order.end());
  if (order.size() <= 2) return order;
  std::vector<int> hull;
  AppendChain(points, order.begin(), order.end(), hull);
  AppendChain(points, order.rbegin(), order.rend(), hull);
  return hull;
}

std::optional<OuterTangents> FindOuterTangents(absl::Span<const Point> a,
                                               absl::Span<const Point> b) {
  assert(!a.empty() && !b.empty());
  std::vector<Point> both(a.begin(), a.end());
  both.insert(both.end(), b.begin(), b.end());
  const int a_size = static_cast<int>(a.size());
  const std::vector<int> hull = ConvexHull(both);
  // An edge of the common hull from one set to the other one is a tangent. Counterclockwise, the
  // hull is to its left: the edge from `a` to `b` is the right one.
  OuterTangents tangents;
  int from_a = 0;
  int from_b = 0;
  for (size_t i = 0; i < hull.size(); ++i) {
    const int tail = hull[i];
    const int head = hull[(i + 1) % hull.size()];
    if (tail < a_size && head >= a_size) {
      tangents.a_right = tail;
      tangents.b_right = head - a_size;
      ++from_a;
    } else if (tail >= a_size && head < a_size) {
      tangents.b_left = tail - a_size;
      tangents.a_left = head;
      ++from_b;
    }
  }
  if (from_a != 1 || from_b != 1) return std::nullopt;
  return tangents;
}

}  // namespace traverse
