#include "client/gcode/print_meter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traverse::gcode {
namespace {

constexpr double kInchMm = 25.4;

double Unit(const MachineState& state) { return state.inches ? kInchMm : 1; }

double LengthXy(const Position& from, const Position& to) {
  return std::hypot(ToDouble(to.x - from.x), ToDouble(to.y - from.y));
}

// The center of the arc relative to its start, in the unit of the words.
void CenterOffset(const Command& command, double dx, double dy, double& i, double& j) {
  i = command.Has('I') ? ToDouble(command.Value('I')) : 0;
  j = command.Has('J') ? ToDouble(command.Value('J')) : 0;
  if (command.Has('I') || command.Has('J') || !command.Has('R')) return;
  // R: the center lies on the chord's bisector, on the right of a G2's chord; negative R: the long
  // way round.
  const double radius = ToDouble(command.Value('R'));
  const double chord = std::hypot(dx, dy);
  if (!(chord > 0)) return;
  const double height = std::sqrt(std::max(radius * radius - chord * chord / 4, 0.0));
  const double side = (command.number == 2) == (radius > 0) ? 1 : -1;
  i = dx / 2 + side * height * dy / chord;
  j = dy / 2 - side * height * dx / chord;
}

}  // namespace

double ArcLength(const Command& command, const Position& from, const Position& to, double unit_mm,
                 double directions[4]) {
  const double dx = ToDouble(to.x - from.x);
  const double dy = ToDouble(to.y - from.y);
  double i;
  double j;
  CenterOffset(command, dx, dy, i, j);
  const double radius = std::hypot(i, j);
  const double turn = command.number == 2 ? -1 : 1;
  double angle = std::atan2(dy - j, dx - i) - std::atan2(-j, -i);
  if (turn * angle <= 1e-9) angle += turn * 2 * std::numbers::pi;
  if (directions != nullptr && radius > 0) {
    directions[0] = turn * j / radius;
    directions[1] = -turn * i / radius;
    directions[2] = -turn * (dy - j) / radius;
    directions[3] = turn * (dx - i) / radius;
  }
  return std::abs(angle) * radius * unit_mm;
}

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
      const double speed = std::min(ToDouble(state.feed) / 60, profile_.max_e_speed);
      if (speed > 0) {
        planner_.Stop(
            StopToStopSeconds(std::abs(ToDouble(step.filament)), speed, profile_.retract_accel));
      }
      return;
    }
    case StepKind::kLift: {
      const double speed = std::min(ToDouble(state.feed) / 60 * Unit(state), profile_.max_z_speed);
      if (speed > 0) {
        const double length = std::abs(ToDouble(state.at.z - step.from.z)) * Unit(state);
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
  const double unit = Unit(state);
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
}

PrintTotals PrintMeter::Finish() {
  planner_.Stop();
  totals_.seconds = planner_.seconds();
  return totals_;
}

}  // namespace traverse::gcode
