// Points in single precision, four at a time: precise enough to find which are near each other.

#ifndef TRAVERSE_ENGINE_GEOMETRY_FLOAT_POINTS_H_
#define TRAVERSE_ENGINE_GEOMETRY_FLOAT_POINTS_H_

#include <cassert>
#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/model/point.h"

namespace traverse {

// In mm, relative to a nearby origin that the caller chooses.
struct FloatPoint {
  float x, y;
};

// Groups of points, padded with their last point to whole vectors. Memory: 8 bytes per point.
class FloatGroups {
 public:
  static constexpr size_t kLanes = 4;

  struct Group {
    const float* x;
    const float* y;
    size_t n;  // including the repeated points
  };

  size_t size() const { return first_.size() - 1; }

  Group of(size_t group) const {
    return {x_.data() + first_[group], y_.data() + first_[group],
            first_[group + 1] - first_[group]};
  }

  // Adds to the last group; ends it. REQUIRES for Close: the group has points.
  void Add(FloatPoint point) {
    x_.push_back(point.x);
    y_.push_back(point.y);
  }
  void Close() {
    assert(x_.size() > first_.back());
    while (x_.size() % kLanes != 0) Add({x_.back(), y_.back()});
    first_.push_back(x_.size());
  }

 private:
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<size_t> first_ = {0};
};

// The number of the point of `group` that is nearest to `from`. It may be a repeated one.
size_t NearestOf(const FloatGroups::Group& group, FloatPoint from);

// The least squared distance between points of two groups.
struct NearestPair {
  float squared;
  size_t there;  // the number of a point of the second group at that distance
};
NearestPair NearestBetween(const FloatGroups::Group& here, const FloatGroups::Group& there);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_FLOAT_POINTS_H_
