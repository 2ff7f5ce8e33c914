#include "engine/geometry/float_points.h"

#include <cstdint>
#include <cstring>
#include <limits>

namespace traverse {
namespace {

// Vectors that every compiler and processor has, if need be in parts.
constexpr size_t kLanes = FloatGroups::kLanes;
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

constexpr float kFar = std::numeric_limits<float>::infinity();

Floats Load(const float* from) {
  Floats values;
  std::memcpy(&values, from, sizeof(values));
  return values;
}

// The squares of the distances from one point to those at `x` and `y`.
Floats Squares(const float* x, const float* y, FloatPoint from) {
  const Floats dx = Load(x) - from.x;
  const Floats dy = Load(y) - from.y;
  return dx * dx + dy * dy;
}

}  // namespace

size_t NearestOf(const FloatGroups::Group& group, FloatPoint from) {
  Floats least = {kFar, kFar, kFar, kFar};
  Ints place = {0, 0, 0, 0};
  for (size_t i = 0; i < group.n; i += kLanes) {
    const Floats squares = Squares(group.x + i, group.y + i, from);
    const Ints nearer = squares < least;
    least = nearer ? squares : least;
    place = nearer ? Ints{} + static_cast<int32_t>(i) : place;
  }
  size_t nearest = 0;
  for (size_t lane = 1; lane < kLanes; ++lane) {
    if (least[lane] < least[nearest]) nearest = lane;
  }
  return static_cast<size_t>(place[nearest]) + nearest;
}

NearestPair NearestBetween(const FloatGroups::Group& here, const FloatGroups::Group& there) {
  NearestPair nearest{kFar, 0};
  for (size_t j = 0; j < there.n; j += kLanes) {
    Floats least = {kFar, kFar, kFar, kFar};
    for (size_t i = 0; i < here.n; ++i) {
      const Floats squares = Squares(there.x + j, there.y + j, {here.x[i], here.y[i]});
      least = squares < least ? squares : least;
    }
    for (size_t lane = 0; lane < kLanes; ++lane) {
      if (least[lane] < nearest.squared) nearest = {least[lane], j + lane};
    }
  }
  return nearest;
}

}  // namespace traverse
