#include "client/gcode/verify/trace/clock.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/verify/machine/command_words.h"
#include "client/gcode/verify/text.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {
namespace {

double PathLengthOf(const Motion& motion) {
  const double flat = FlatLength(motion);
  const auto rise = static_cast<double>(motion.to[2] - motion.from[2]);
  const double length = std::hypot(flat, rise);
  return length > 0 ? length : std::abs(static_cast<double>(motion.filament));
}

// `G4 S1.5` or `G4 P1500`.
double DwellSeconds(std::string_view line) {
  const CommandWords words(WordsOf(line));
  if (!words.readable) return 0;
  const double seconds = static_cast<double>(words.ValueOr('S', 0)) * kMicro;
  const double milliseconds = static_cast<double>(words.ValueOr('P', 0)) * kMicro;
  return std::max(words.Has('S') ? seconds : milliseconds / 1000, 0.0);
}

}  // namespace

double FlatLength(const Motion& motion) {
  const Point from = PointOf(motion.from, 1);
  const Point to = PointOf(motion.to, 1);
  if (!motion.has_center && motion.radius == 0) return std::hypot(to.x - from.x, to.y - from.y);
  const ArcWay way(from, to, ArcOf(motion, 1));
  return way.angle() * way.radius();
}

double SecondsOf(const VerifyLine& line, const VerifyMachine& machine) {
  // Some dwells belong to the moves around them.
  if (line.command == Mix('G', 4) || (line.moves && machine.motion().number == 4)) {
    return DwellSeconds(line.text);
  }
  if (line.role != LineRole::kDeposit && !line.moves) return 0;
  const Motion& motion = machine.motion();
  return motion.feed > 0 ? PathLengthOf(motion) / static_cast<double>(motion.feed) * 60 : 0;
}

}  // namespace traverse::gcode
