#include "client/gcode/machine/machine_limits.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/files/utf8_mark.h"
#include "client/gcode/machine/klipper_limits.h"
#include "client/gcode/machine/limit_text.h"
#include "client/gcode/machine/machine_profile.h"
#include "client/gcode/text/lexer.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

constexpr char kNeither[] =
    "neither a Klipper configuration, with [printer], nor lines of M201 to "
    "M205";

// One word of Marlin that is read, in the order in which they count.
struct Word {
  int number;
  char letter;
  LimitField field;
  Range range = kAboveZero;
  double per_second = 1;  // 60 where it counts mm/min
};
constexpr Word kWords[] = {
    {201, 'X', &MachineLimits::max_accel},
    {201, 'Y', &MachineLimits::max_accel},
    {201, 'Z', &MachineLimits::z_accel},
    {201, 'E', &MachineLimits::retract_accel},
    {202, 'X', &MachineLimits::travel_accel},
    {202, 'Y', &MachineLimits::travel_accel},
    {203, 'X', &MachineLimits::max_speed},
    {203, 'Y', &MachineLimits::max_speed},
    {203, 'Z', &MachineLimits::max_z_speed},
    {203, 'E', &MachineLimits::max_e_speed},
    {204, 'S', &MachineLimits::print_accel},
    {204, 'S', &MachineLimits::travel_accel},
    {204, 'P', &MachineLimits::print_accel},
    {204, 'T', &MachineLimits::travel_accel},
    {204, 'R', &MachineLimits::retract_accel},
    {205, 'X', &MachineLimits::corner_speed},
    {205, 'Y', &MachineLimits::corner_speed},
    {205, 'J', &MachineLimits::junction_deviation},
    {207, 'S', &MachineLimits::firmware_retract_length, kFromZero},
    {207, 'F', &MachineLimits::firmware_retract_speed, kAboveZero, 60},
    {208, 'S', &MachineLimits::firmware_prime_extra, kFromZero},
    {208, 'F', &MachineLimits::firmware_prime_speed, kAboveZero, 60},
    {566, 'X', &MachineLimits::corner_speed, kAboveZero, 60},
    {566, 'Y', &MachineLimits::corner_speed, kAboveZero, 60},
};

class MarlinReader {
 public:
  explicit MarlinReader(const std::string& name) : name_(name) {}

  absl::StatusOr<MachineLimits> Read(std::string_view text) {
    duet_ = text.find("M566") != std::string_view::npos;
    const absl::Status status =
        ForEachLine(text, [this](std::string_view line, int number) { return Take(line, number); });
    if (!status.ok()) return status;
    if (!any_) return LimitFault(name_, 0, kNeither);
    return limits_;
  }

 private:
  absl::Status Take(std::string_view line, int number) {
    bool said = false;  // by the firmware: it need not be a command
    line = WithoutMarks(line, said);
    Command command;
    LexLine(line, command);
    if (command.kind == LineKind::kText && !said) {
      return LimitFault(name_, any_ ? number : 0,
                        any_ ? "neither a command nor a comment" : kNeither);
    }
    if (command.Is('G', 20) || command.Is('G', 21)) unit_mm_ = command.number == 20 ? 25.4 : 1;
    const bool ours = command.kind == LineKind::kCommand && command.letter == 'M' &&
                      std::any_of(std::begin(kWords), std::end(kWords),
                                  [&](const Word& word) { return word.number == command.number; });
    // There M208 says how far the axes reach.
    if (!ours || (duet_ && command.number == 208)) return absl::OkStatus();
    if (!ReadWords(command)) {
      return LimitFault(name_, number,
                        absl::StrFormat("M%d: its words cannot be read", command.number));
    }
    any_ = any_ || command.number <= 205;
    return Follow(command, number);
  }

  // Terminals show who said a line, firmware begins what is no answer with `echo:`.
  static std::string_view WithoutMarks(std::string_view line, bool& said) {
    line = TrimBlanks(line);
    for (const std::string_view mark : {"Recv:", "<<<", "<", "Send:", "SENDING:", ">>>", ">"}) {
      if (line.starts_with(mark)) {
        line = TrimBlanks(line.substr(mark.size()));
        break;
      }
    }
    constexpr std::string_view kEcho = "echo:";
    said = line.starts_with(kEcho) || line == "ok" || line == "wait" || line == "start";
    return line.starts_with(kEcho) ? TrimBlanks(line.substr(kEcho.size())) : line;
  }

  absl::Status Follow(const Command& command, int number) {
    for (const Word& word : kWords) {
      if (command.number != word.number || !command.Has(word.letter)) continue;
      const double value = ToDouble(command.Value(word.letter));
      if (!word.range.holds(value)) {
        return LimitFault(
            name_, number,
            absl::StrFormat("M%d %c: %s", word.number, word.letter, word.range.fault));
      }
      std::optional<double>& field = limits_.*word.field;
      const double per_second = duet_ && command.number == 203 ? 60 : word.per_second;
      const double mm = value * unit_mm_ / per_second;
      // Moves lead anywhere: of X and Y the slower one counts.
      const bool slower = word.letter == 'Y' && command.Has('X') && field;
      field = slower ? std::min(*field, mm) : mm;
    }
    return absl::OkStatus();
  }

  const std::string& name_;
  bool duet_ = false;  // RepRapFirmware
  double unit_mm_ = 1;
  bool any_ = false;
  MachineLimits limits_;
};

// A section: a line that begins with a bracket.
bool LooksLikeKlipper(std::string_view text) {
  return text.starts_with('[') || text.find("\n[") != std::string_view::npos;
}

}  // namespace

absl::StatusOr<MachineLimits> ReadMachineLimits(std::string_view text, const std::string& name,
                                                const ReadIncludes& includes) {
  text = WithoutUtf8Mark(text);
  if (LooksLikeKlipper(text)) return ReadKlipperLimits(text, name, includes);
  return MarlinReader(name).Read(text);
}

void ApplyLimits(const MachineLimits& limits, MachineProfile& profile) {
  const auto set = [](double& field, const std::optional<double>& value) {
    if (value) field = *value;
  };
  set(profile.max_speed, limits.max_speed);
  set(profile.max_accel, limits.max_accel);
  set(profile.z_accel, limits.z_accel);
  set(profile.max_z_speed, limits.max_z_speed);
  set(profile.corner_speed, limits.corner_speed);
  set(profile.cruise_ratio, limits.cruise_ratio);
  set(profile.firmware_retract_length, limits.firmware_retract_length);
  set(profile.firmware_retract_speed, limits.firmware_retract_speed);
  profile.firmware_prime_speed = profile.firmware_retract_speed;
  set(profile.firmware_prime_speed, limits.firmware_prime_speed);
  set(profile.firmware_prime_extra, limits.firmware_prime_extra);
  profile.klipper = limits.klipper;
  if (limits.klipper) {
    // One acceleration for all moves, and by default what extruding needs at most for filament.
    profile.print_accel = profile.travel_accel = *limits.max_accel;
    profile.max_accel = kGreatestLimit;
    profile.extruder_corner_speed = *limits.extruder_corner_speed;
    profile.arc_chord = *limits.arc_chord;
    const double nozzle = limits.nozzle_diameter.value_or(profile.nozzle_diameter.value_or(0.4));
    const double radius = limits.filament_diameter.value_or(profile.filament_diameter) / 2;
    const double ratio = 4 * nozzle * nozzle / (std::numbers::pi * radius * radius);
    profile.max_e_speed = ratio * *limits.max_speed;
    profile.retract_accel = ratio * *limits.max_accel;
  }
  set(profile.print_accel, limits.print_accel);
  set(profile.travel_accel, limits.travel_accel);
  set(profile.max_e_speed, limits.max_e_speed);
  set(profile.retract_accel, limits.retract_accel);
  if (limits.junction_deviation) {
    // The corner speed at a right angle of the circle that misses the corner by so much.
    const double accel = std::min(profile.print_accel, profile.max_accel);
    profile.corner_speed =
        std::sqrt((1 + std::numbers::sqrt2) * accel * *limits.junction_deviation);
  }
}

}  // namespace traverse::gcode
