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
  // `profile` outlives the meter; `dynamics` are those in force at the beginning.
  PrintMeter(const MachineProfile& profile, const Dynamics& dynamics)
      : profile_(profile), dynamics_(dynamics) {}

  // Follows one step of `interpreter`, which has just made it.
  void Follow(const Step& step, const Interpreter& interpreter);

  // What was followed so far; the machine comes to a standstill.
  PrintTotals Finish();

 private:
  void FollowXy(const Step& step, const MachineState& state);

  const MachineProfile& profile_;
  Dynamics dynamics_;
  MotionPlanner planner_;
  PrintTotals totals_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PRINT_METER_H_
