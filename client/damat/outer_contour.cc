#include "client/damat/outer_contour.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace traverse::damat {
namespace {

using Points = google::protobuf::RepeatedField<double>;

// Limit of the edges examined for one island.
constexpr int64_t kMostEdges = 50'000'000;

// A vertex this close to the outer contour is not outside it.
constexpr double kTouchingMm = 1e-6;

double Area(const Points& points) {
  double twice = 0;
  const int n = points.size() / 2;
  for (int i = 0; i < n; ++i) {
    const int j = i + 1 < n ? i + 1 : 0;
    // Relative to the first vertex, so that large coordinates leave digits for small areas.
    twice += (points[2 * i] - points[0]) * (points[2 * j + 1] - points[1]) -
             (points[2 * j] - points[0]) * (points[2 * i + 1] - points[1]);
  }
  return std::abs(twice) / 2;
}

struct Box {
  double low[2] = {std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  double high[2] = {-std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};
};

Box BoxOf(const Points& points) {
  Box box;
  for (int i = 0; i < points.size(); ++i) {
    box.low[i % 2] = std::min(box.low[i % 2], points[i]);
    box.high[i % 2] = std::max(box.high[i % 2], points[i]);
  }
  return box;
}

bool Apart(const Box& a, const Box& b) {
  for (const int axis : {0, 1}) {
    if (a.low[axis] > b.high[axis] + kTouchingMm || b.low[axis] > a.high[axis] + kTouchingMm) {
      return true;
    }
  }
  return false;
}

double DistanceToEdge(double x, double y, double x1, double y1, double x2, double y2) {
  const double dx = x2 - x1;
  const double dy = y2 - y1;
  const double square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp(((x - x1) * dx + (y - y1) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(x - x1 - t * dx, y - y1 - t * dy);
}

bool IsWithin(double x, double y, const Points& ring) {
  bool within = false;
  const int n = ring.size() / 2;
  for (int i = 0, j = n - 1; i < n; j = i++) {
    const double x1 = ring[2 * i], y1 = ring[2 * i + 1];
    const double x2 = ring[2 * j], y2 = ring[2 * j + 1];
    if (DistanceToEdge(x, y, x1, y1, x2, y2) <= kTouchingMm) return true;
    if ((y1 > y) != (y2 > y) && x < (x2 - x1) * (y - y1) / (y2 - y1) + x1) within = !within;
  }
  return within;
}

}  // namespace

OuterContour FindOuterContour(const v1::Island& island) {
  OuterContour found;
  double largest = 0;
  for (int i = 0; i < island.contours_size(); ++i) {
    const double area = Area(island.contours(i).points());
    if (area <= largest) continue;
    largest = area;
    found.index = i;
  }
  if (largest == 0) return found;
  const Points& outer = island.contours(found.index).points();
  const Box outer_box = BoxOf(outer);
  int64_t edges = 0;
  for (int i = 0; i < island.contours_size(); ++i) {
    if (i == found.index) continue;
    const Points& points = island.contours(i).points();
    bool outside = Apart(BoxOf(points), outer_box);
    if (!outside && edges < kMostEdges) {
      outside = true;
      for (int p = 0; p + 1 < points.size() && outside && edges < kMostEdges; p += 2) {
        outside = !IsWithin(points[p], points[p + 1], outer);
        edges += outer.size() / 2;
      }
      outside = outside && edges < kMostEdges;
    }
    if (outside) found.outside.push_back(i);
  }
  return found;
}

}  // namespace traverse::damat
