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

PlannerRules RulesOf(const MachineProfile& profile) {
  return {profile.klipper, profile.cruise_ratio, profile.extruder_corner_speed};
}

}  // namespace

double StandstillSeconds(const Step& step, const MachineState& state,
                         const MachineProfile& profile) {
  const double feed = ToDouble(state.feed) / 60;
  const auto seconds = [](double length, double speed, double accel) {
    return speed > 0 ? StopToStopSeconds(length, speed, accel) : 0;
  };
  switch (step.kind) {
    case StepKind::kFilament:
      return seconds(std::abs(ToDouble(step.filament)), std::min(feed, profile.max_e_speed),
                     profile.retract_accel);
    case StepKind::kLift:
      return seconds(std::abs(ToDouble(state.at.z - step.from.z)) * state.UnitMm(),
                     std::min(feed * state.UnitMm(), profile.max_z_speed), profile.z_accel);
    case StepKind::kFirmwareRetract:
      return seconds(profile.firmware_retract_length,
                     std::min(profile.firmware_retract_speed, profile.max_e_speed),
                     profile.retract_accel);
    case StepKind::kFirmwareUnretract:
      return seconds(profile.firmware_retract_length,
                     std::min(profile.firmware_prime_speed, profile.max_e_speed),
                     profile.retract_accel);
    default:
      return 0;
  }
}

PrintMeter::PrintMeter(const MachineProfile& profile, const Dynamics& dynamics,
                       const VisibleWalls* walls)
    : profile_(profile), dynamics_(dynamics), walls_(walls), planner_(RulesOf(profile)) {}

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
      return planner_.Stop(StandstillSeconds(step, state, profile_));
    }
    case StepKind::kFirmwareRetract:
      if (!step.retracted) ++totals_.retractions;
      [[fallthrough]];
    case StepKind::kFirmwareUnretract:
    case StepKind::kLift:
      return planner_.Stop(StandstillSeconds(step, state, profile_));
    case StepKind::kSlot:
      if ((step.slots & kDynamicsSlots) != 0) {
        dynamics_.Follow(step.line.Text(interpreter.text()));
      }
      return;
    default:
      return;
  }
}

double PrintMeter::MoveXy(const Step& step, const MachineState& state) {
  const double unit = state.UnitMm();
  const double speed = std::min(ToDouble(state.feed) / 60 * unit, dynamics_.max_speed());
  const bool extrudes = step.kind == StepKind::kExtrude;
  const double accel = extrudes ? dynamics_.print_accel() : dynamics_.travel_accel();
  const double corner = dynamics_.corner_speed();
  if (step.arc) {
    double way[4] = {1, 0, 1, 0};
    const double length = ArcLength(step.command, step.from, state.at, unit, way);
    planner_.Arc(length, way[0], way[1], way[2], way[3], speed, accel, corner);
    return length;
  }
  planner_.Move(ToDouble(state.at.x - step.from.x) * unit,
                ToDouble(state.at.y - step.from.y) * unit, speed, accel, corner);
  return LengthXy(step.from, state.at) * unit;
}

double PrintMeter::MoveKlipper(const Step& step, const MachineState& state) {
  const double unit = state.UnitMm();
  const double flat = step.arc ? ArcLength(step.command, step.from, state.at, unit)
                               : LengthXy(step.from, state.at) * unit;
  if (!(flat > 0)) return 0;
  const double rise = std::abs(ToDouble(state.at.z - step.from.z)) * unit;
  const double length = std::hypot(flat, rise);
  const double filament = ToDouble(step.filament) / length;
  double speed = std::min(ToDouble(state.feed) / 60 * unit, dynamics_.max_speed());
  double accel = dynamics_.travel_accel();
  // What one axis may is the more along a way on which it moves less.
  const auto limit = [&](double share, double most_speed, double most_accel) {
    speed = std::min(speed, most_speed / share);
    accel = std::min(accel, most_accel / share);
  };
  if (rise > 0) limit(rise / length, profile_.max_z_speed, profile_.z_accel);
  if (filament < 0) limit(-filament, profile_.max_e_speed, profile_.retract_accel);
  std::vector<Vertex> points = {state.InMm(step.from)};
  if (step.arc) {
    const double chords = std::max(std::floor(flat / profile_.arc_chord), 1.0);
    for (const Vertex& point : ArcChords(step.command, step.from, state.at, unit, chords)) {
      points.push_back(point);
    }
  }
  points.push_back(state.InMm(state.at));
  planner_.set_cruise_ratio(dynamics_.cruise_ratio());
  for (size_t i = 1; i < points.size(); ++i) {
    planner_.Move((points[i].x - points[i - 1].x) * length / flat,
                  (points[i].y - points[i - 1].y) * length / flat, speed, accel,
                  dynamics_.corner_speed(), filament);
  }
  return flat;
}

void PrintMeter::FollowXy(const Step& step, const MachineState& state) {
  const bool extrudes = step.kind == StepKind::kExtrude;
  const double length = profile_.klipper ? MoveKlipper(step, state) : MoveXy(step, state);
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
