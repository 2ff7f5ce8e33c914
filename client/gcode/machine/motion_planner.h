// Estimates how long a machine takes for its moves.
//
// The model follows the planners of Marlin and Klipper:
// - each move has a trapezoidal speed: its feed rate, its acceleration, entry and exit speed;
// - between two moves in the plane, at an angle t to each other, the speed is at most
//   c * sqrt(2) / (2 sin(t / 2)): the corner speed c at a right angle, no limit straight on;
// - the planner looks ahead: a move is entered no faster than what follows allows to brake for;
// - the machine stands still before and after moves of Z or of the extruder alone.
// Left out: heating, the extruder's own limits while printing, steps and pressure advance.
//
// For a machine that runs Klipper it plans as Klipper does (Klipper's Kinematics.md):
// - a corner is rounded on the circle that misses it by as much as a right angle at the corner
//   speed would, and that touches both moves no farther away than their midpoints;
// - Z is an axis like the others, so a lift and the travel after it form a corner too; a slow axis
//   slows the corners that it takes part in;
// - the extruder's speed changes at once by no more than its own corner speed;
// - a share of each way up to a speed and down again is at constant speed: the peak is the speed
//   reached with the acceleration reduced by that share.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_MOTION_PLANNER_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_MOTION_PLANNER_H_

#include <cstddef>
#include <vector>

namespace traverse::gcode {

// Time from standstill to standstill in s for `length` at `speed` and `accel` (mm or mm of
// filament; above 0).
double StopToStopSeconds(double length, double speed, double accel);

// How a machine goes around corners.
struct PlannerRules {
  bool klipper = false;
  double cruise_ratio = 0;           // share of a move that is at constant speed, below 1
  double extruder_corner_speed = 0;  // mm/s of filament
};

// A straight move, by mm along each axis.
struct MoveInSpace {
  double dx = 0;
  double dy = 0;
  double dz = 0;
  double speed = 0;  // mm/s, at most
  double accel = 0;  // mm/s^2, as far as its axes allow
  // The acceleration that the machine is set to. The share at constant speed refers to it, and the
  // corner speed to a move with it; a slower move takes corners more slowly.
  double machine_accel = 0;
  double corner = 0;    // mm/s, from 0, to the move before it and behind it
  double filament = 0;  // mm of it for each mm
};

class MotionPlanner {
 public:
  explicit MotionPlanner(const PlannerRules& rules = {}) : rules_(rules) {}

  // For the moves from now on; in [0, 1).
  void set_cruise_ratio(double ratio) { rules_.cruise_ratio = ratio; }

  // A move by (dx, dy) mm at most `speed` mm/s with `accel` mm/s^2. `corner` mm/s is the corner
  // speed to the move before it.
  void Move(double dx, double dy, double speed, double accel, double corner);

  // By Klipper's rules, with Z and the extruder. REQUIRES: the planner has them.
  void Move(const MoveInSpace& move);

  // A move along an arc of `length_mm` that begins in direction (bx, by) and ends in direction
  // (ex, ey), both of length 1.
  void Arc(double length_mm, double bx, double by, double ex, double ey, double speed, double accel,
           double corner);

  // The machine stops, and stands for `seconds`.
  void Stop(double seconds = 0);

  // Seconds up to the last stop.
  double seconds() const { return seconds_; }

 private:
  struct Direction {
    double x = 0;
    double y = 0;
    double z = 0;
  };

  struct Segment {
    double length = 0;
    double speed2 = 0;  // squares of speeds, (mm/s)^2
    double accel = 0;
    double limit2 = 0;  // of the corner before it
    double entry2 = 0;  // planned: at most limit2, and low enough to brake for what follows

    // By Klipper's rules: how much speed^2 grows with the acceleration less the share of cruising,
    // and how far a corner may be missed, times the acceleration.
    double slow_gain2 = 0;
    double missing2 = 0;
  };

  // The corner between the last queued move and one that begins in direction `begin`.
  double KlipperLimit2(const Direction& begin, const Segment& next, double filament) const;

  // Queues a move that ends in direction `end`, behind a corner taken at the root of `limit2`.
  void Queue(double length, double speed2, double accel, double limit2, const Direction& end,
             double slow_gain2 = 0, double missing2 = 0);

  // Fills slow2_ and peaks2_, so that each way up to a speed and down again has its cruise.
  void FindPeaks();

  // Plans what is queued, up to a standstill, and takes `count` segments out.
  void Plan(size_t count);

  static constexpr size_t kWindow = 512;

  PlannerRules rules_;
  std::vector<Segment> queue_;
  Direction last_;  // in which the last queued move ends
  double last_filament_ = 0;
  double entry2_ = 0;  // speed at which the first queued segment is entered

  // Of Klipper's rules: for each queued segment the speed at which it would be entered with less
  // acceleration, one more for the end, and the peak that it belongs to; and what both were before
  // the first one.
  std::vector<double> slow2_;
  std::vector<double> peaks2_;
  double slow_entry2_ = 0;
  double peak_entry2_ = 0;
  double seconds_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_MOTION_PLANNER_H_
