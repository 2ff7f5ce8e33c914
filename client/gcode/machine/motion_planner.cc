#include "client/gcode/machine/motion_planner.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace traverse::gcode {
namespace {

// Half the angle of a turn that is none has a sine below this.
constexpr double kStraight = 1e-9;

constexpr double kNoLimit = 1e18;

// A speed and its square.
struct Speed {
  explicit Speed(double squared) : value2(squared), value(std::sqrt(squared)) {}

  double value2;
  double value;
};

// Time for `length` from speed `entry` to `exit`, at most the root of `speed2`, with `accel`.
double TrapezoidSeconds(double length, const Speed& entry, const Speed& exit, double speed2,
                        double accel) {
  // Where full acceleration and full braking meet.
  const double peak2 = accel * length + (entry.value2 + exit.value2) / 2;
  if (peak2 <= speed2) return (2 * std::sqrt(peak2) - entry.value - exit.value) / accel;
  const double speed = std::sqrt(speed2);
  const double ramps = ((speed2 - entry.value2) + (speed2 - exit.value2)) / (2 * accel);
  return (2 * speed - entry.value - exit.value) / accel + (length - ramps) / speed;
}

}  // namespace

double StopToStopSeconds(double length, double speed, double accel) {
  if (length <= 0) return 0;
  return TrapezoidSeconds(length, Speed(0), Speed(0), speed * speed, accel);
}

void MotionPlanner::Move(double dx, double dy, double speed, double accel, double corner) {
  if (rules_.klipper) {
    return Move({.dx = dx,
                 .dy = dy,
                 .speed = speed,
                 .accel = accel,
                 .machine_accel = accel,
                 .corner = corner});
  }
  const double length = std::sqrt(dx * dx + dy * dy);
  if (!(length > 0)) return;
  const double x = dx / length;
  const double y = dy / length;
  Arc(length, x, y, x, y, speed, accel, corner);
}

void MotionPlanner::Move(const MoveInSpace& move) {
  assert(rules_.klipper);
  const double length = std::hypot(move.dx, move.dy, move.dz);
  if (!(length > 0) || !(move.speed > 0)) return;
  const Direction along{move.dx / length, move.dy / length, move.dz / length};
  Segment segment{length, move.speed * move.speed, move.accel};
  const double slow_accel = std::min(move.accel, (1 - rules_.cruise_ratio) * move.machine_accel);
  segment.slow_gain2 = 2 * slow_accel * length;
  // What a right angle at the corner speed misses it by.
  segment.missing2 =
      (std::numbers::sqrt2 - 1) * move.corner * move.corner * move.accel / move.machine_accel;
  const double limit2 = queue_.empty() ? 0 : KlipperLimit2(along, segment, move.filament);
  last_filament_ = move.filament;
  Queue(length, segment.speed2, segment.accel, limit2, along, segment.slow_gain2, segment.missing2);
}

void MotionPlanner::Arc(double length_mm, double bx, double by, double ex, double ey, double speed,
                        double accel, double corner) {
  if (!(length_mm > 0) || !(speed > 0)) return;
  // 2 sin(t / 2) squared is 2 - 2 cos t.
  const double turn2 = std::max(2 - 2 * (last_.x * bx + last_.y * by), 1e-9);
  Queue(length_mm, speed * speed, accel, 2 * corner * corner / turn2, {ex, ey});
}

void MotionPlanner::Queue(double length, double speed2, double accel, double limit2,
                          const Direction& end, double slow_gain2, double missing2) {
  limit2 = queue_.empty() ? 0 : std::min({limit2, speed2, queue_.back().speed2});
  // Filled where it is: a copy would have to wait until its parts are written.
  Segment& segment = queue_.emplace_back();
  segment.length = length;
  segment.speed2 = speed2;
  segment.accel = accel;
  segment.limit2 = segment.entry2 = limit2;
  segment.slow_gain2 = slow_gain2;
  segment.missing2 = missing2;
  last_ = end;
  if (queue_.size() >= kWindow) Plan(kWindow / 2);
}

double MotionPlanner::KlipperLimit2(const Direction& begin, const Segment& next,
                                    double filament) const {
  const Segment& last = queue_.back();
  const double cosine = last_.x * begin.x + last_.y * begin.y + last_.z * begin.z;
  const double half_cos = std::sqrt(std::max((1 + cosine) / 2, 0.0));
  const double half_sin = std::sqrt(std::max((1 - cosine) / 2, 0.0));
  double limit2 = kNoLimit;
  if (half_sin > kStraight) {
    // On a circle that misses the corner by d the radius is d cos / (1 - cos), of half the angle.
    const double radius = half_cos / (1 - half_cos);
    const double middle = half_cos / half_sin / 2;
    limit2 = std::min({radius * next.missing2, radius * last.missing2,
                       middle * next.accel * next.length, middle * last.accel * last.length});
  }
  const double change = std::abs(filament - last_filament_);
  if (change > 0) {
    const double extruder = rules_.extruder_corner_speed / change;
    limit2 = std::min(limit2, extruder * extruder);
  }
  return limit2;
}

void MotionPlanner::Stop(double seconds) {
  if (!queue_.empty()) Plan(queue_.size());
  entry2_ = 0;
  seconds_ += seconds;
}

// With the acceleration less the share of cruising the machine would go more slowly, but up and
// down in the same places; it is to be no faster than the peaks of that. A peak holds as far as the
// speed rises to it and falls from it.
void MotionPlanner::FindPeaks() {
  const size_t n = queue_.size();
  slow2_.assign(n + 1, 0);
  peaks2_.resize(n);
  const auto gain2 = [this](size_t i) { return queue_[i].slow_gain2; };
  for (size_t i = n; i-- > 0;) slow2_[i] = std::min(queue_[i].limit2, slow2_[i + 1] + gain2(i));
  slow2_[0] = slow_entry2_;
  for (size_t i = 0; i < n; ++i) slow2_[i + 1] = std::min(slow2_[i + 1], slow2_[i] + gain2(i));
  const auto falls = [&](size_t i) { return slow2_[i + 1] + gain2(i) <= slow2_[i]; };
  double next2 = 0;
  for (size_t i = n; i-- > 0;) {
    const bool rises = slow2_[i] + gain2(i) <= slow2_[i + 1];
    if (falls(i)) {
      next2 = slow2_[i];
    } else if (!rises) {
      next2 = (slow2_[i] + slow2_[i + 1] + gain2(i)) / 2;
    }
    peaks2_[i] = next2;
  }
  double before2 = peak_entry2_;
  for (size_t i = 0; i < n; ++i) {
    if (falls(i)) peaks2_[i] = std::max(peaks2_[i], before2);
    before2 = peaks2_[i];
  }
}

void MotionPlanner::Plan(size_t count) {
  if (rules_.klipper) FindPeaks();
  double next2 = 0;
  for (size_t i = queue_.size(); i-- > 0;) {
    Segment& segment = queue_[i];
    segment.entry2 = std::min(segment.limit2, next2 + 2 * segment.accel * segment.length);
    if (rules_.klipper && i > 0) {
      segment.entry2 = std::min({segment.entry2, peaks2_[i], peaks2_[i - 1]});
    }
    next2 = segment.entry2;
  }
  Speed entry(entry2_);
  for (size_t i = 0; i < count; ++i) {
    const Segment& segment = queue_[i];
    const double limit2 = i + 1 < queue_.size() ? queue_[i + 1].entry2 : 0;
    const Speed leave(std::min(limit2, entry.value2 + 2 * segment.accel * segment.length));
    const double most2 = rules_.klipper ? std::min(segment.speed2, peaks2_[i]) : segment.speed2;
    // What was planned before more was known may be a little faster.
    const double speed2 = std::max({most2, entry.value2, leave.value2});
    seconds_ += TrapezoidSeconds(segment.length, entry, leave, speed2, segment.accel);
    entry = leave;
  }
  entry2_ = entry.value2;
  if (rules_.klipper) {
    slow_entry2_ = count < queue_.size() ? slow2_[count] : 0;
    peak_entry2_ = count < queue_.size() ? peaks2_[count - 1] : 0;
  }
  queue_.erase(queue_.begin(), queue_.begin() + static_cast<std::ptrdiff_t>(count));
}

}  // namespace traverse::gcode
