// A point in the plane of a layer.

#ifndef TRAVERSE_ENGINE_MODEL_POINT_H_
#define TRAVERSE_ENGINE_MODEL_POINT_H_

#include <cmath>

namespace traverse {

// In mm.
struct Point {
  double x = 0;
  double y = 0;

  friend bool operator==(const Point&, const Point&) = default;
};

// Euclidean distance in mm. Coordinates are bounded (kMaxCoordinateMm), so the slower,
// overflow-proof std::hypot is not needed.
inline double Distance(Point a, Point b) {
  const double dx = a.x - b.x;
  const double dy = a.y - b.y;
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_POINT_H_
