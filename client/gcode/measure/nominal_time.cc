#include "client/gcode/measure/nominal_time.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/model/arc.h"

namespace traverse::gcode {
namespace {

double Seconds(double mm, double mm_s) { return mm_s > 0 ? mm / mm_s : 0; }

double DwellSeconds(const Step& step) {
  Command command = step.command;
  if (!command.Is('G', 4) || !ReadWords(command)) return 0;
  if (command.Has('S')) return std::max(ToDouble(command.Value('S')), 0.0);
  return command.Has('P') ? std::max(ToDouble(command.Value('P')), 0.0) / 1000 : 0;
}

// Beside G10 and G11.
double LengthMm(const Step& step, const MachineState& state) {
  const double unit = state.UnitMm();
  const double rise = ToDouble(state.at.z - step.from.z) * unit;
  switch (step.kind) {
    case StepKind::kExtrude:
    case StepKind::kZeroExtrude:
    case StepKind::kTravel:
    case StepKind::kWipe: {
      const double dx = ToDouble(state.at.x - step.from.x) * unit;
      const double dy = ToDouble(state.at.y - step.from.y) * unit;
      const double flat = step.arc ? ArcLength(step.command, step.from, state.at, unit)
                                   : std::sqrt(dx * dx + dy * dy);
      return rise == 0 ? flat : std::hypot(flat, rise);
    }
    case StepKind::kLift:
      return std::abs(rise);
    case StepKind::kFilament:
      return std::abs(ToDouble(step.filament)) * unit;
    default:
      return 0;
  }
}

}  // namespace

double NominalSeconds(const Step& step, const MachineState& state, const MachineProfile& profile) {
  switch (step.kind) {
    case StepKind::kUnknown:
      return DwellSeconds(step);
    case StepKind::kFirmwareRetract:
      return Seconds(profile.firmware_retract_length, profile.firmware_retract_speed);
    case StepKind::kFirmwareUnretract:
      return Seconds(profile.firmware_retract_length + profile.firmware_prime_extra,
                     profile.firmware_prime_speed);
    default:
      return Seconds(LengthMm(step, state), ToDouble(state.feed) / 60 * state.UnitMm());
  }
}

}  // namespace traverse::gcode
