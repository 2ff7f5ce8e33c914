// The smallest axis-parallel rectangle that contains some points.

#ifndef TRAVERSE_ENGINE_GEOMETRY_BOUNDING_BOX_H_
#define TRAVERSE_ENGINE_GEOMETRY_BOUNDING_BOX_H_

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "absl/types/span.h"
#include "engine/model/point.h"

namespace traverse {

// In mm. Empty until the first point is added.
class BoundingBox {
 public:
  BoundingBox() = default;
  explicit BoundingBox(absl::Span<const Point> points) {
    for (const Point& point : points) Add(point);
  }

  void Add(Point point) {
    low_ = {std::min(low_.x, point.x), std::min(low_.y, point.y)};
    high_ = {std::max(high_.x, point.x), std::max(high_.y, point.y)};
  }

  void Add(const BoundingBox& other) {
    low_ = {std::min(low_.x, other.low_.x), std::min(low_.y, other.low_.y)};
    high_ = {std::max(high_.x, other.high_.x), std::max(high_.y, other.high_.y)};
  }

  bool empty() const { return low_.x > high_.x; }
  Point low() const { return low_; }
  Point high() const { return high_; }

  // Each of these REQUIRES: not empty.
  double width() const {
    assert(!empty());
    return high_.x - low_.x;
  }
  double height() const {
    assert(!empty());
    return high_.y - low_.y;
  }
  double shorter_side() const { return std::min(width(), height()); }
  Point center() const {
    assert(!empty());
    return {(low_.x + high_.x) / 2, (low_.y + high_.y) / 2};
  }

  // Squared distance from `point` to the nearest point of the box; infinite if that is empty. No
  // point of the box is nearer, even with rounding, because each step rounds both the same way.
  double SquaredDistanceTo(Point point) const {
    const double dx = std::max({low_.x - point.x, point.x - high_.x, 0.0});
    const double dy = std::max({low_.y - point.y, point.y - high_.y, 0.0});
    return dx * dx + dy * dy;
  }

  // From the point or box to the nearest point of this box; 0 if they touch.
  double DistanceTo(Point point) const { return std::sqrt(SquaredDistanceTo(point)); }
  double DistanceTo(const BoundingBox& other) const {
    const double dx = std::max({low_.x - other.high_.x, other.low_.x - high_.x, 0.0});
    const double dy = std::max({low_.y - other.high_.y, other.low_.y - high_.y, 0.0});
    return std::sqrt(dx * dx + dy * dy);
  }

  // From `point` to the farthest corner.
  double FarthestCornerDistance(Point point) const {
    return Distance(
        point, {point.x > center().x ? low_.x : high_.x, point.y > center().y ? low_.y : high_.y});
  }

 private:
  BoundingBox(Point low, Point high) : low_(low), high_(high) {}

  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Point low_{kFar, kFar};
  Point high_{-kFar, -kFar};
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_BOUNDING_BOX_H_
