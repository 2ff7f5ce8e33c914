#include "client/gcode/measure/print_meter.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/measure/nominal_time.h"
#include "client/gcode/model/arc.h"

namespace traverse::gcode {
namespace {

// A move of one axis alone, Z or the extruder.
struct AxisMove {
  double length = 0;  // mm
  double speed = 0;
  double accel = 0;
};

// `step` is filament alone, a lift, G10 or G11; `state` is how the machine is behind it.
AxisMove AxisMoveOf(const Step& step, const MachineState& state, const MachineProfile& profile) {
  const double feed = ToDouble(state.feed) / 60;
  const auto of_extruder = [&profile](double length, double speed) {
    return AxisMove{length, std::min(speed, profile.max_e_speed), profile.retract_accel};
  };
  switch (step.kind) {
    case StepKind::kFirmwareRetract:
      return of_extruder(profile.firmware_retract_length, profile.firmware_retract_speed);
    case StepKind::kFirmwareUnretract:
      return of_extruder(profile.firmware_retract_length + profile.firmware_prime_extra,
                         profile.firmware_prime_speed);
    case StepKind::kLift:
      return {std::abs(ToDouble(state.at.z - step.from.z)) * state.UnitMm(),
              std::min(feed * state.UnitMm(), profile.max_z_speed), profile.z_accel};
    default:
      return of_extruder(std::abs(ToDouble(step.filament)), feed);
  }
}

}  // namespace

PrintMeter::PrintMeter(const MachineProfile& profile, const Dynamics& dynamics,
                       const VisibleWalls* walls)
    : profile_(profile),
      dynamics_(dynamics),
      walls_(walls),
      planner_({profile.klipper, profile.cruise_ratio, profile.extruder_corner_speed}) {}

void PrintMeter::Follow(const Step& step, const Interpreter& interpreter) {
  if (step.kind != StepKind::kSlot) return Follow(step, interpreter.state());
  if ((step.slots & kDynamicsSlots) == 0) return;
  dynamics_.Follow(step.line.Text(interpreter.text()));
}

void PrintMeter::Follow(const Step& step, const MachineState& state) {
  switch (step.kind) {
    case StepKind::kExtrude:
    case StepKind::kZeroExtrude:
    case StepKind::kTravel:
    case StepKind::kWipe:
      if (step.filament < 0 && !step.retracted) ++totals_.retractions;
      return FollowXy(step, state);
    case StepKind::kFilament: {
      if (step.filament < 0 && !step.retracted) ++totals_.retractions;
      const Decimal extra = step.filament - step.pulled;
      const bool primes_short =
          step.filament > 0 && extra < -kRetractionSlack && state.retracted == 0;
      if (extra > (step.pulled > 0 ? kRetractionSlack : 0) || primes_short) {
        totals_.extra_mm += ToDouble(extra);
      }
      return Stand(step, state);
    }
    case StepKind::kFirmwareRetract:
      if (!step.retracted) ++totals_.retractions;
      [[fallthrough]];
    case StepKind::kFirmwareUnretract:
      return Stand(step, state);
    case StepKind::kLift:
      if (profile_.klipper) {
        MoveKlipper(step, state);
        return;
      }
      return Stand(step, state);
    case StepKind::kDwell:
    case StepKind::kUnknown:
      if (step.command.Is('G', 4)) planner_.Stop(NominalSeconds(step, state));
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
    double directions[4] = {1, 0, 1, 0};
    const double length = ArcLength(step.command, step.from, state.at, unit, directions);
    planner_.Arc(length, directions[0], directions[1], directions[2], directions[3], speed, accel,
                 corner);
    return length;
  }
  planner_.Move(ToDouble(state.at.x - step.from.x) * unit,
                ToDouble(state.at.y - step.from.y) * unit, speed, accel, corner);
  return StepLengthMm(step, state);
}

double PrintMeter::MoveKlipper(const Step& step, const MachineState& state) {
  const double unit = state.UnitMm();
  const double flat = StepLengthMm(step, state);
  const double rise = ToDouble(state.at.z - step.from.z) * unit;
  const double length = std::hypot(flat, rise);
  if (!(length > 0)) return 0;
  MoveInSpace move;
  move.speed = std::min(ToDouble(state.feed) / 60 * unit, dynamics_.max_speed());
  move.accel = move.machine_accel = dynamics_.travel_accel();
  move.corner = dynamics_.corner_speed();
  move.filament = ToDouble(step.filament) / length;
  // An axis allows the more, the less of the move is its own.
  const auto limit = [&move](double share, double most_speed, double most_accel) {
    move.speed = std::min(move.speed, most_speed / share);
    move.accel = std::min(move.accel, most_accel / share);
  };
  if (rise != 0) limit(std::abs(rise) / length, profile_.max_z_speed, profile_.z_accel);
  if (move.filament < 0) limit(-move.filament, profile_.max_e_speed, profile_.retract_accel);
  std::vector<Point> points = {state.InMm(step.from)};
  if (step.arc) {
    const double chords = std::max(std::floor(length / profile_.arc_chord), 1.0);
    for (const Point& point : ArcChords(step.command, step.from, state.at, unit, chords)) {
      points.push_back(point);
    }
  }
  points.push_back(state.InMm(state.at));
  planner_.set_cruise_ratio(dynamics_.cruise_ratio());
  move.dz = rise / static_cast<double>(points.size() - 1);
  for (size_t i = 1; i < points.size(); ++i) {
    move.dx = points[i].x - points[i - 1].x;
    move.dy = points[i].y - points[i - 1].y;
    planner_.Move(move);
  }
  return flat;
}

void PrintMeter::Stand(const Step& step, const MachineState& state) {
  const AxisMove move = AxisMoveOf(step, state, profile_);
  planner_.Stop();
  if (!(move.speed > 0)) return;
  if (!profile_.klipper) {
    return planner_.Stop(StopToStopSeconds(move.length, move.speed, move.accel));
  }
  planner_.set_cruise_ratio(dynamics_.cruise_ratio());
  planner_.Move({.dx = move.length,
                 .speed = move.speed,
                 .accel = move.accel,
                 .machine_accel = dynamics_.travel_accel()});
  planner_.Stop();
}

void PrintMeter::FollowXy(const Step& step, const MachineState& state) {
  const bool extrudes = step.kind == StepKind::kExtrude;
  const double length = profile_.klipper ? MoveKlipper(step, state) : MoveXy(step, state);
  (extrudes ? totals_.extruded_mm : totals_.travel_mm) += length;
  if (extrudes) EndTravel();
  if (step.kind != StepKind::kTravel || walls_ == nullptr) return;
  const TravelLine move{state.InMm(step.from), state.InMm(state.at)};
  if (!crosses_ && walls_->Crossed(move.from, move.to)) {
    crosses_ = true;
    crosses_open_ = !step.retracted;
  }
  if (step.retracted) return;
  departs_ = open_moves_.empty() ? length <= kMaxDepartureMm && !walls_->IsOnOne(move.to)
                                 : departs_ && (open_moves_.size() > 1 || state.feed == feed_);
  feed_ = state.feed;
  open_moves_.push_back(move);
  open_mm_ += length;
}

// Of a travel move that begins with a short move inwards, the walls near its bend count, too.
void PrintMeter::EndTravel() {
  const bool bends = departs_ && open_moves_.size() > 1;
  if (!crosses_ && bends) crosses_ = crosses_open_ = walls_->CrossedByMoves(open_moves_);
  totals_.crossings += crosses_ ? 1 : 0;
  if (crosses_open_) {
    ++totals_.open_crossings;
    totals_.longest_open_mm = std::max(totals_.longest_open_mm, open_mm_);
  }
  crosses_ = crosses_open_ = departs_ = false;
  open_moves_.clear();
  open_mm_ = 0;
}

PrintTotals PrintMeter::Finish() {
  EndTravel();
  planner_.Stop();
  totals_.seconds = planner_.seconds();
  return totals_;
}

}  // namespace traverse::gcode
