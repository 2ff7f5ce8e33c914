#include "client/gcode/plan/loop_stops.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "client/gcode/machine/motion_planner.h"

namespace traverse::gcode {
namespace {

// The vertices of a loop, one after the other in either direction.
class Lap {
 public:
  explicit Lap(const std::vector<Vertex>& points) : points_(points), sides_(points.size() - 1) {}

  size_t sides() const { return sides_; }
  size_t Next(size_t vertex, bool backwards) const {
    if (backwards) return vertex > 0 ? vertex - 1 : sides_ - 1;
    return vertex + 1 < sides_ ? vertex + 1 : 0;
  }
  double Mm(size_t a, size_t b) const { return Distance(points_[a], points_[b]); }

 private:
  const std::vector<Vertex>& points_;
  const size_t sides_;
};

}  // namespace

Vertex Direction(Vertex from, Vertex to) {
  const double length = Distance(from, to);
  return length > 0 ? Vertex{(to.x - from.x) / length, (to.y - from.y) / length} : Vertex{};
}

// The slowest corner is taken as fast as it may be. From there on in each direction the machine
// speeds up.
LoopStops::LoopStops(const std::vector<Vertex>& points, const Pace& pace) {
  assert(points.size() > 1 && pace.speed_mm_s > 0 && pace.accel_mm_s2 > 0);
  const Lap lap(points);
  const size_t n = lap.sides();
  const auto speed2 = static_cast<float>(pace.speed_mm_s * pace.speed_mm_s);
  passing2_.reserve(n);
  for (size_t v = 0; v < n; ++v) {
    const Vertex in = Direction(points[lap.Next(v, true)], points[v]);
    const Vertex out = Direction(points[v], points[lap.Next(v, false)]);
    const double cosine = in.x * out.x + in.y * out.y;
    const auto corner2 = static_cast<float>(CornerSpeed2(cosine, pace.corner_speed));
    passing2_.push_back(std::min(speed2, corner2));
  }
  const auto slowest =
      static_cast<size_t>(std::min_element(passing2_.begin(), passing2_.end()) - passing2_.begin());
  for (const bool backwards : {false, true}) {
    size_t v = slowest;
    for (size_t i = 0; i < n; ++i) {
      const size_t next = lap.Next(v, backwards);
      const auto reached2 =
          static_cast<float>(passing2_[v] + 2 * pace.accel_mm_s2 * lap.Mm(v, next));
      passing2_[next] = std::min(passing2_[next], reached2);
      v = next;
    }
  }
}

double LoopStops::Seconds(const std::vector<Vertex>& points, const Pace& pace,
                          uint32_t vertex) const {
  const Lap lap(points);
  assert(passing2_.size() == lap.sides() && vertex < lap.sides());
  double seconds = 0;
  for (const bool backwards : {false, true}) {
    size_t v = vertex;
    double now2 = 0;
    for (size_t i = 0; i < lap.sides() && now2 < passing2_[v]; ++i) {
      const size_t next = lap.Next(v, backwards);
      const double mm = lap.Mm(v, next);
      const double next2 = std::min<double>(passing2_[next], now2 + 2 * pace.accel_mm_s2 * mm);
      const auto takes = [&](double in2, double out2) {
        return RampedSeconds(mm, in2, out2, pace.speed_mm_s, pace.accel_mm_s2);
      };
      seconds += takes(now2, next2) - takes(passing2_[v], passing2_[next]);
      now2 = next2;
      v = next;
    }
  }
  return seconds;
}

}  // namespace traverse::gcode
