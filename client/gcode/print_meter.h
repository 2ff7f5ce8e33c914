// Measures a print while an interpreter follows it: way, retractions, time.

#ifndef TRAVERSE_CLIENT_GCODE_PRINT_METER_H_
#define TRAVERSE_CLIENT_GCODE_PRINT_METER_H_

#include <string_view>

#include "client/gcode/interpreter.h"
#include "client/gcode/machine_profile.h"
#include "client/gcode/motion_planner.h"
#include "client/gcode/print_totals.h"

namespace traverse::gcode {

class PrintMeter {
 public:
  // `profile` outlives the meter.
  explicit PrintMeter(const MachineProfile& profile) : profile_(profile), dynamics_(profile) {}

  // Follows one step of `interpreter`, which has just made it.
  void Follow(const Step& step, const Interpreter& interpreter);

  // What was measured since the last call, but for the time.
  PrintTotals Take();

  // Seconds since the beginning, up to the last standstill: a print comes to one whenever filament
  // or Z alone moves.
  double seconds() const { return planner_.seconds(); }

  // Brings the machine to a standstill.
  void Stop() { planner_.Stop(); }

 private:
  void FollowXy(const Step& step, const MachineState& state);

  const MachineProfile& profile_;
  Dynamics dynamics_;
  MotionPlanner planner_;
  PrintTotals totals_;
};

// The length in mm of the arc that `command` (G2 or G3) makes between two positions, and optionally
// the directions in which it begins and ends (bx, by, ex, ey). `unit_mm` is the length of one unit.
double ArcLength(const Command& command, const Position& from, const Position& to, double unit_mm,
                 double directions[4] = nullptr);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PRINT_METER_H_
