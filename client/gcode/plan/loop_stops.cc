#include "client/gcode/plan/loop_stops.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace traverse::gcode {
namespace {

// Of a segment of `mm` that is entered and left at speeds of these squares, which `pace` allows.
double SegmentSeconds(double mm, double in2, double out2, const Pace& pace) {
  const double speed2 = pace.speed_mm_s * pace.speed_mm_s;
  const double peak2 = std::min(speed2, (in2 + out2) / 2 + pace.accel_mm_s2 * mm);
  const double ramps = (2 * std::sqrt(peak2) - std::sqrt(in2) - std::sqrt(out2)) / pace.accel_mm_s2;
  const double ramps_mm = (2 * peak2 - in2 - out2) / (2 * pace.accel_mm_s2);
  return ramps + std::max(mm - ramps_mm, 0.0) / pace.speed_mm_s;
}

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

double CornerSpeed2(Vertex in, Vertex out, double corner_speed) {
  const double turn2 = std::max(2 - 2 * (in.x * out.x + in.y * out.y), 1e-9);
  return 2 * corner_speed * corner_speed / turn2;
}

Vertex Direction(Vertex from, Vertex to) {
  const double length = Distance(from, to);
  return length > 0 ? Vertex{(to.x - from.x) / length, (to.y - from.y) / length} : Vertex{};
}

// The slowest corner is taken as fast as it may be. From there on in each direction the machine
// speeds up.
LoopStops::LoopStops(const std::vector<Vertex>& points, const Pace& pace) {
  const Lap lap(points);
  const size_t n = lap.sides();
  const auto speed2 = static_cast<float>(pace.speed_mm_s * pace.speed_mm_s);
  passing2_.reserve(n);
  for (size_t v = 0; v < n; ++v) {
    const Vertex in = Direction(points[lap.Next(v, true)], points[v]);
    const Vertex out = Direction(points[v], points[lap.Next(v, false)]);
    const auto corner2 = static_cast<float>(CornerSpeed2(in, out, pace.corner_speed));
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
      seconds += SegmentSeconds(mm, now2, next2, pace) -
                 SegmentSeconds(mm, passing2_[v], passing2_[next], pace);
      now2 = next2;
      v = next;
    }
  }
  return seconds;
}

}  // namespace traverse::gcode
