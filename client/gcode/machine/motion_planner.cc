#include "client/gcode/machine/motion_planner.h"

#include <algorithm>
#include <cmath>

namespace traverse::gcode {
namespace {

// Time for `length` from speed^2 `entry2` to `exit2`, at most `speed2`, with `accel`.
double TrapezoidSeconds(double length, double entry2, double exit2, double speed2, double accel) {
  const double entry = std::sqrt(entry2);
  const double exit = std::sqrt(exit2);
  // Where full acceleration and full braking meet.
  const double peak2 = accel * length + (entry2 + exit2) / 2;
  if (peak2 <= speed2) return (2 * std::sqrt(peak2) - entry - exit) / accel;
  const double speed = std::sqrt(speed2);
  const double ramps = ((speed2 - entry2) + (speed2 - exit2)) / (2 * accel);
  return (2 * speed - entry - exit) / accel + (length - ramps) / speed;
}

}  // namespace

double StopToStopSeconds(double length, double speed, double accel) {
  if (length <= 0) return 0;
  return TrapezoidSeconds(length, 0, 0, speed * speed, accel);
}

void MotionPlanner::Move(double dx, double dy, double speed, double accel, double corner) {
  const double length = std::sqrt(dx * dx + dy * dy);
  if (!(length > 0)) return;
  const double x = dx / length;
  const double y = dy / length;
  Arc(length, x, y, x, y, speed, accel, corner);
}

void MotionPlanner::Arc(double length_mm, double bx, double by, double ex, double ey, double speed,
                        double accel, double corner) {
  if (!(length_mm > 0) || !(speed > 0)) return;
  const double speed2 = speed * speed;
  double limit2 = 0;
  if (!queue_.empty()) {
    // 2 sin(t / 2) squared is 2 - 2 cos t.
    const double turn2 = std::max(2 - 2 * (last_x_ * bx + last_y_ * by), 1e-9);
    limit2 = std::min({2 * corner * corner / turn2, speed2, queue_.back().speed2});
  }
  queue_.push_back(Segment{length_mm, speed2, accel, limit2, limit2});
  last_x_ = ex;
  last_y_ = ey;
  if (queue_.size() >= kWindow) Plan(0, kWindow / 2);
}

void MotionPlanner::Stop(double seconds) {
  if (!queue_.empty()) Plan(0, queue_.size());
  entry2_ = 0;
  seconds_ += seconds;
}

void MotionPlanner::Plan(double exit2, size_t count) {
  double next2 = exit2;
  for (size_t i = queue_.size(); i-- > 0;) {
    Segment& segment = queue_[i];
    segment.entry2 = std::min(segment.limit2, next2 + 2 * segment.accel * segment.length);
    next2 = segment.entry2;
  }
  double entry2 = entry2_;
  for (size_t i = 0; i < count; ++i) {
    const Segment& segment = queue_[i];
    const double limit2 = i + 1 < queue_.size() ? queue_[i + 1].entry2 : exit2;
    const double leave2 = std::min(limit2, entry2 + 2 * segment.accel * segment.length);
    seconds_ += TrapezoidSeconds(segment.length, entry2, leave2, segment.speed2, segment.accel);
    entry2 = leave2;
  }
  entry2_ = entry2;
  queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace traverse::gcode
