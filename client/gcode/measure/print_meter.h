// Measures a print while an interpreter follows it: travel, retractions, time.

#ifndef TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_METER_H_
#define TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_METER_H_

#include <vector>

#include "client/gcode/machine/interpreter.h"
#include "client/gcode/machine/machine_profile.h"
#include "client/gcode/machine/motion_planner.h"
#include "client/gcode/measure/print_totals.h"
#include "client/gcode/model/visible_walls.h"

namespace traverse::gcode {

class PrintMeter {
 public:
  // `profile` and `walls` outlive the meter; `dynamics` are those in force at the beginning.
  // Crossings are counted where there are `walls`: null for none.
  PrintMeter(const MachineProfile& profile, const Dynamics& dynamics, const VisibleWalls* walls);

  // Follows one step of `interpreter`, which has just made it.
  void Follow(const Step& step, const Interpreter& interpreter);

  // The same for one that sets nothing, behind which the machine is in `state`.
  void Follow(const Step& step, const MachineState& state);

  // From now on `dynamics` are in force.
  void Set(const Dynamics& dynamics) { dynamics_ = dynamics; }

  // Comes to a standstill.
  void Stop() { planner_.Stop(); }

  // The totals so far; the machine comes to a standstill.
  PrintTotals Finish();

 private:
  void FollowXy(const Step& step, const MachineState& state);

  // Queues the move, by the rules of Klipper or of other firmware. Returns its length in the plane
  // in mm.
  double MoveXy(const Step& step, const MachineState& state);
  double MoveKlipper(const Step& step, const MachineState& state);

  // Queues a move of filament alone or a lift; the machine stands still before and after it.
  void Stand(const Step& step, const MachineState& state);
  void EndTravel();

  const MachineProfile& profile_;
  Dynamics dynamics_;
  const VisibleWalls* walls_;

  // The travel since the last extrusion.
  bool crosses_ = false;
  bool crosses_open_ = false;
  std::vector<TravelLine> open_moves_;  // without a retraction
  double open_mm_ = 0;
  bool departs_ = false;  // begins with a short move, as fast as the next one, away from walls
  Decimal feed_ = 0;      // of the last of them

  MotionPlanner planner_;
  PrintTotals totals_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MEASURE_PRINT_METER_H_
