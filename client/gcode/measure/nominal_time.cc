#include "client/gcode/measure/nominal_time.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/model/arc.h"

namespace traverse::gcode {
namespace {

double DwellSeconds(const Step& step) {
  Command command = step.command;
  if (!ReadWords(command)) return 0;
  if (command.Has('S')) return std::max(ToDouble(command.Value('S')), 0.0);
  return command.Has('P') ? std::max(ToDouble(command.Value('P')), 0.0) / 1000 : 0;
}

// The move goes along its arc and rises meanwhile; the filament counts where nothing else moves.
double LengthMm(const Step& step, const MachineState& state) {
  const double unit = state.UnitMm();
  const double flat = StepLengthMm(step, state);
  const double rise = ToDouble(state.at.z - step.from.z) * unit;
  const double length = rise == 0 ? flat : std::hypot(flat, rise);
  return length > 0 ? length : std::abs(ToDouble(step.filament)) * unit;
}

}  // namespace

double NominalSeconds(const Step& step, const MachineState& state) {
  const Command& command = step.command;
  if (command.Is('G', 4)) return DwellSeconds(step);
  const double mm_s = ToDouble(state.feed) / 60 * state.UnitMm();
  return command.Moves() && mm_s > 0 ? LengthMm(step, state) / mm_s : 0;
}

}  // namespace traverse::gcode
