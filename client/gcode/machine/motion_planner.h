// Estimates how long a machine takes for its moves.
//
// The model, in the way of Marlin's and Klipper's planners:
// - each move has a trapezoidal speed: its feed rate, its acceleration, entry and exit speed;
// - between two moves in the plane, at an angle t to each other, the speed is at most
//   c * sqrt(2) / (2 sin(t / 2)): the corner speed c at a right angle, no limit straight on;
// - the planner looks ahead: a move is entered no faster than what follows allows to brake for;
// - the machine stands still before and after moves of Z or of the extruder alone.
// Left out: heating, the extruder's own limits while printing, steps and pressure advance.
//
// Told that the machine runs Klipper, it plans as that does (its document Kinematics.md):
// - a corner is taken on the circle that misses it by as much as a right angle at the corner speed
//   would, and that touches both moves no farther away than in their middle;
// - the extruder's speed changes at once by no more than its own corner speed;
// - of a way that goes up to a speed and down again, a share is at constant speed: the peak is the
//   one that is reached with the acceleration less that share.

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
  double cruise_ratio = 0;           // share of a way that is at constant speed, below 1
  double extruder_corner_speed = 0;  // mm/s of filament
};

class MotionPlanner {
 public:
  explicit MotionPlanner(const PlannerRules& rules = {}) : rules_(rules) {}

  // For the moves from here on; from 0 to below 1.
  void set_cruise_ratio(double ratio) { rules_.cruise_ratio = ratio; }

  // A move by (dx, dy) mm at most `speed` mm/s with `accel` mm/s^2. `corner` mm/s is the corner
  // speed to the move before it; `filament` mm of it are pushed for each mm.
  void Move(double dx, double dy, double speed, double accel, double corner, double filament = 0);

  // A move along an arc of `length_mm` that begins in direction (bx, by) and ends in direction
  // (ex, ey), both of length 1.
  void Arc(double length_mm, double bx, double by, double ex, double ey, double speed, double accel,
           double corner, double filament = 0);

  // The machine stops, and stands for `seconds`.
  void Stop(double seconds = 0);

  // Seconds of everything up to the last stop.
  double seconds() const { return seconds_; }

 private:
  struct Segment {
    double length;
    double speed2;  // squares of speeds, (mm/s)^2
    double accel;
    double limit2;      // of the corner before it
    double entry2;      // planned: at most limit2, and low enough to brake for what follows
    double slow_gain2;  // of speed^2, with the acceleration less the share of cruising
  };

  // The corner between the last queued move and one that begins in direction (bx, by).
  double CornerLimit2(double bx, double by, double corner) const;
  double KlipperLimit2(double bx, double by, double corner, const Segment& next,
                       double filament) const;

  // Fills slow2_ and peaks2_, so that each way up to a speed and down again has its cruise.
  void FindPeaks();
  double Speed2(size_t i) const;

  // Plans what is queued, with speed `exit2` after the last segment, and takes `count` segments
  // out.
  void Plan(double exit2, size_t count);

  static constexpr size_t kWindow = 512;

  PlannerRules rules_;
  std::vector<Segment> queue_;
  double last_x_ = 0;  // direction in which the last queued move ends
  double last_y_ = 0;
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
