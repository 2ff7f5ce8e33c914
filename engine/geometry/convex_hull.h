// Convex hulls, and the outer tangents of two sets of points.
//
// Source: the monotone chain of Andrew (1979), "Another efficient algorithm for convex hulls in two
// dimensions".

#ifndef TRAVERSE_ENGINE_GEOMETRY_CONVEX_HULL_H_
#define TRAVERSE_ENGINE_GEOMETRY_CONVEX_HULL_H_

#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "engine/model/point.h"

namespace traverse {

// Twice the signed area of the triangle a, b, c: positive if c lies to the left of a -> b.
inline double Cross(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Indices of the corners of the convex hull of `points`, counterclockwise from the leftmost (of
// several the lowest). Points on an edge are not corners, nor are repeated points after the first
// one. One point, or points on a line, give one or two corners; no points give none. O(n log n).
std::vector<int> ConvexHull(absl::Span<const Point> points);

// The two lines that touch both of two sets of points and have both sets on one side, each given by
// the points where it touches (indices). Seen from the first set towards the second,
//
//        a_left  o-------------o  b_left
//        (first set)       (second set)
//        a_right o-------------o  b_right
//
// both sets lie to the right of a_left -> b_left and to the left of a_right -> b_right.
struct OuterTangents {
  int a_left = 0;
  int b_left = 0;
  int a_right = 0;
  int b_right = 0;
};

// Unset if there are not exactly two: one hull lies in the other, or they cross. REQUIRES: neither
// set is empty. O(n log n).
std::optional<OuterTangents> FindOuterTangents(absl::Span<const Point> a,
                                               absl::Span<const Point> b);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_CONVEX_HULL_H_
