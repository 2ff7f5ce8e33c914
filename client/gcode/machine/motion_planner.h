// Estimates how long a machine takes for its moves.
//
// The model, in the way of Marlin's and Klipper's planners:
// - each move has a trapezoidal speed: its feed rate, its acceleration, entry and exit speed;
// - between two moves in the plane, at an angle t to each other, the speed is at most
//   c * sqrt(2) / (2 sin(t / 2)): the corner speed c at a right angle, no limit straight on;
// - the planner looks ahead: a move is entered no faster than what follows allows to brake for;
// - the machine stands still before and after moves of Z or of the extruder alone.
// Left out: heating, the extruder's own limits while printing, steps and pressure advance.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_MOTION_PLANNER_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_MOTION_PLANNER_H_

#include <cstddef>
#include <vector>

namespace traverse::gcode {

// Time from standstill to standstill in s for `length` at `speed` and `accel` (mm or mm of
// filament; above 0).
double StopToStopSeconds(double length, double speed, double accel);

class MotionPlanner {
 public:
  // A move by (dx, dy) mm at most `speed` mm/s with `accel` mm/s^2. `corner` mm/s is the corner
  // speed to the move before it.
  void Move(double dx, double dy, double speed, double accel, double corner);

  // A move along an arc of `length_mm` that begins in direction (bx, by) and ends in direction
  // (ex, ey), both of length 1.
  void Arc(double length_mm, double bx, double by, double ex, double ey, double speed, double accel,
           double corner);

  // The machine stops, and stands for `seconds`.
  void Stop(double seconds = 0);

  // Seconds of everything up to the last stop.
  double seconds() const { return seconds_; }

 private:
  struct Segment {
    double length;
    double speed2;  // squares of speeds, (mm/s)^2
    double accel;
    double limit2;  // of the corner before it
    double entry2;  // planned: at most limit2, and low enough to brake for what follows
  };

  // Plans what is queued, with speed `exit2` after the last segment, and takes `count` segments
  // out.
  void Plan(double exit2, size_t count);

  static constexpr size_t kWindow = 512;

  std::vector<Segment> queue_;
  double last_x_ = 0;  // direction in which the last queued move ends
  double last_y_ = 0;
  double entry2_ = 0;  // speed at which the first queued segment is entered
  double seconds_ = 0;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_MOTION_PLANNER_H_
