#include "client/gcode/measure/print_meter.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/model/arc.h"

namespace traverse::gcode {
namespace {

// Of what is pulled back in several moves, rounding may lose so much.
constexpr Decimal kRounding = kDecimalOne / 10'000;

double LengthXy(const Position& from, const Position& to) {
  const double dx = ToDouble(to.x - from.x);
  const double dy = ToDouble(to.y - from.y);
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

void PrintMeter::Follow(const Step& step, const Interpreter& interpreter) {
  const MachineState& state = interpreter.state();
  switch (step.kind) {
    case StepKind::kExtrude:
    case StepKind::kZeroExtrude:
    case StepKind::kTravel:
    case StepKind::kWipe:
      if (step.kind == StepKind::kWipe && !step.retracted) ++totals_.retractions;
      return FollowXy(step, state);
    case StepKind::kFilament: {
      if (step.filament < 0 && !step.retracted) ++totals_.retractions;
      if (step.filament > step.pulled + (step.pulled > 0 ? kRounding : 0)) {
        totals_.extra_mm += ToDouble(step.filament - step.pulled);
      }
      const double speed = std::min(ToDouble(state.feed) / 60, profile_.max_e_speed);
      if (speed > 0) {
        planner_.Stop(
            StopToStopSeconds(std::abs(ToDouble(step.filament)), speed, profile_.retract_accel));
      }
      return;
    }
    case StepKind::kLift: {
      const double speed =
          std::min(ToDouble(state.feed) / 60 * state.UnitMm(), profile_.max_z_speed);
      if (speed > 0) {
        const double length = std::abs(ToDouble(state.at.z - step.from.z)) * state.UnitMm();
        planner_.Stop(StopToStopSeconds(length, speed, profile_.z_accel));
      }
      return;
    }
    case StepKind::kFirmwareRetract:
    case StepKind::kFirmwareUnretract:
      if (step.kind == StepKind::kFirmwareRetract && !step.retracted) ++totals_.retractions;
      return planner_.Stop(StopToStopSeconds(profile_.firmware_retract_length,
                                             profile_.firmware_retract_speed,
                                             profile_.retract_accel));
    case StepKind::kSlot:
      if ((step.slots & kDynamicsSlots) != 0) {
        dynamics_.Follow(step.line.Text(interpreter.text()));
      }
      return;
    default:
      return;
  }
}

void PrintMeter::FollowXy(const Step& step, const MachineState& state) {
  const double unit = state.UnitMm();
  const double speed = ToDouble(state.feed) / 60 * unit;
  const bool extrudes = step.kind == StepKind::kExtrude;
  const double accel = extrudes ? dynamics_.print_accel() : dynamics_.travel_accel();
  double length;
  if (step.arc) {
    double way[4] = {1, 0, 1, 0};
    length = ArcLength(step.command, step.from, state.at, unit, way);
    planner_.Arc(length, way[0], way[1], way[2], way[3], speed, accel, dynamics_.corner_speed());
  } else {
    length = LengthXy(step.from, state.at) * unit;
    planner_.Move(ToDouble(state.at.x - step.from.x) * unit,
                  ToDouble(state.at.y - step.from.y) * unit, speed, accel,
                  dynamics_.corner_speed());
  }
  (extrudes ? totals_.extruded_mm : totals_.travel_mm) += length;
  if (extrudes) crosses_ = false;
  if (step.kind == StepKind::kTravel && walls_ != nullptr && !crosses_) NoteCrossing(step, state);
}

void PrintMeter::NoteCrossing(const Step& step, const MachineState& state) {
  crosses_ = walls_->Crossed(state.InMm(step.from), state.InMm(state.at));
  if (!crosses_) return;
  ++totals_.crossings;
  if (step.retracted) return;
  ++totals_.open_crossings;
  totals_.longest_open_mm =
      std::max(totals_.longest_open_mm, LengthXy(step.from, state.at) * state.UnitMm());
}

PrintTotals PrintMeter::Finish() {
  planner_.Stop();
  totals_.seconds = planner_.seconds();
  return totals_;
}

}  // namespace traverse::gcode
