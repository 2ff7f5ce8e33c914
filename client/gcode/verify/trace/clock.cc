#include "client/gcode/verify/trace/clock.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/verify/machine/command_words.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

double Across(const std::array<Micro, 3>& a, double x, double y) {
  return std::hypot(static_cast<double>(a[0]) - x, static_cast<double>(a[1]) - y);
}

// Of an arc by its radius, the long way round if that is negative.
double LengthByRadius(double chord, double radius) {
  const double least = std::max(std::abs(radius), chord / 2);
  if (chord <= 0) return 0;
  const double angle = 2 * std::asin(chord / 2 / least);
  return least * (radius < 0 ? 2 * M_PI - angle : angle);
}

}  // namespace

double FlatLength(const Motion& motion) {
  const double chord =
      Across(motion.from, static_cast<double>(motion.to[0]), static_cast<double>(motion.to[1]));
  if (motion.radius != 0) return LengthByRadius(chord, static_cast<double>(motion.radius));
  if (!motion.has_center) return chord;
  const auto x = static_cast<double>(motion.center_x);
  const auto y = static_cast<double>(motion.center_y);
  const double begin =
      std::atan2(static_cast<double>(motion.from[1]) - y, static_cast<double>(motion.from[0]) - x);
  const double end =
      std::atan2(static_cast<double>(motion.to[1]) - y, static_cast<double>(motion.to[0]) - x);
  double turn = motion.number == 2 ? begin - end : end - begin;
  if (turn <= 1e-9) turn += 2 * M_PI;
  return turn * Across(motion.from, x, y);
}

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

void Clock::Take(const VerifyLine& line, const VerifyMachine& machine) {
  // Some dwells belong to the moves around them.
  if (line.command == Mix('G', 4) || (line.moves && machine.motion().number == 4)) {
    seconds_ += DwellSeconds(line.text);
  } else if (line.role == LineRole::kDeposit || line.moves) {
    const Motion& motion = machine.motion();
    if (motion.feed > 0) seconds_ += PathLengthOf(motion) / static_cast<double>(motion.feed) * 60;
  }
}

}  // namespace traverse::gcode
