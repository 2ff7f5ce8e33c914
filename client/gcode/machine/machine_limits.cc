#include "client/gcode/machine/machine_limits.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "absl/status/status.h"
#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/files/utf8_mark.h"
#include "client/gcode/text/lexer.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// Beyond all machines, and far from where sums of squares are not finite.
constexpr double kMost = 1e9;

constexpr char kNeither[] =
    "neither a Klipper configuration, with [printer], nor lines of M201 to "
    "M205";

absl::Status Fault(const std::string& where, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(where, ": ", what));
}

std::string At(const std::string& name, int line) { return absl::StrFormat("%s:%d", name, line); }

// Calls visit(line, number from 1) until that is a fault.
template <typename Visit>
absl::Status ForEachLine(std::string_view text, Visit visit) {
  int number = 0;
  for (Offset next = 0; next < text.size();) {
    const Line line = LineAt(text, next);
    next = line.next;
    if (absl::Status status = visit(line.Text(text), ++number); !status.ok()) return status;
  }
  return absl::OkStatus();
}

// Which values a setting may have.
enum class Range { kAboveZero, kFromZero, kRatio };

bool Holds(Range range, double value) {
  switch (range) {
    case Range::kAboveZero:
      return value > 0 && value <= kMost;
    case Range::kFromZero:
      return value >= 0 && value <= kMost;
    case Range::kRatio:
      return value >= 0 && value < 1;
  }
  return false;
}

const char* NameOf(Range range) {
  switch (range) {
    case Range::kAboveZero:
      return "not a number above 0 and up to 1e9";
    case Range::kFromZero:
      return "not a number from 0 to 1e9";
    case Range::kRatio:
      return "not a number from 0 to below 1";
  }
  return "";
}

using Field = std::optional<double> MachineLimits::*;

// One setting of Klipper that is read.
struct Setting {
  std::string_view section;
  std::string_view key;
  Field field;
  Range range = Range::kAboveZero;
  bool lowers = false;  // the field may also be set by others; the least value counts
};

constexpr Setting kSettings[] = {
    {"printer", "max_velocity", &MachineLimits::max_speed},
    {"printer", "max_accel", &MachineLimits::max_accel},
    {"printer", "square_corner_velocity", &MachineLimits::corner_speed, Range::kFromZero},
    {"printer", "minimum_cruise_ratio", &MachineLimits::cruise_ratio, Range::kRatio},
    {"printer", "max_z_velocity", &MachineLimits::max_z_speed},
    {"printer", "max_z_accel", &MachineLimits::z_accel},
    // Of kinematics that limit each axis. Moves lead anywhere: the slower axis counts.
    {"printer", "max_x_velocity", &MachineLimits::max_speed, Range::kAboveZero, true},
    {"printer", "max_y_velocity", &MachineLimits::max_speed, Range::kAboveZero, true},
    {"printer", "max_x_accel", &MachineLimits::max_accel, Range::kAboveZero, true},
    {"printer", "max_y_accel", &MachineLimits::max_accel, Range::kAboveZero, true},
    {"extruder", "nozzle_diameter", &MachineLimits::nozzle_diameter},
    {"extruder", "filament_diameter", &MachineLimits::filament_diameter},
    {"extruder", "max_extrude_only_velocity", &MachineLimits::max_e_speed},
    {"extruder", "max_extrude_only_accel", &MachineLimits::retract_accel},
    {"extruder", "instantaneous_corner_velocity", &MachineLimits::extruder_corner_speed,
     Range::kFromZero},
    {"firmware_retraction", "retract_length", &MachineLimits::firmware_retract_length,
     Range::kFromZero},
    {"firmware_retraction", "retract_speed", &MachineLimits::firmware_retract_speed},
    {"firmware_retraction", "unretract_speed", &MachineLimits::firmware_prime_speed},
    {"firmware_retraction", "unretract_extra_length", &MachineLimits::firmware_prime_extra,
     Range::kFromZero},
    {"gcode_arcs", "resolution", &MachineLimits::arc_chord},
};

class KlipperReader {
 public:
  explicit KlipperReader(const std::string& name) : name_(name) { limits_.klipper = true; }

  absl::StatusOr<MachineLimits> Read(std::string_view text) {
    const absl::Status status =
        ForEachLine(text, [this](std::string_view line, int number) { return Take(line, number); });
    if (!status.ok()) return status;
    const char* unread = includes_ ? "; files that it includes are not read" : "";
    if (!has_printer_) return Fault(name_, absl::StrCat("it has no [printer]", unread));
    for (const auto& [field, key] : {std::pair(limits_.max_speed, "max_velocity"),
                                     std::pair(limits_.max_accel, "max_accel")}) {
      if (!field) return Fault(name_, absl::StrFormat("[printer] has no %s%s", key, unread));
    }
    FillDefaults();
    return limits_;
  }

 private:
  absl::Status Take(std::string_view line, int number) {
    line = line.substr(0, std::min(line.find('#'), line.find(';')));
    // What is indented goes on with a value of several lines: a macro.
    if (line.empty() || line[0] == ' ' || line[0] == '\t' || line[0] == '\r') {
      return absl::OkStatus();
    }
    line = TrimBlanks(line);
    if (line.front() == '[') return BeginSection(line, number);
    const size_t mark = line.find_first_of(":=");
    if (mark == std::string_view::npos) return absl::OkStatus();
    const std::string key = absl::AsciiStrToLower(std::string(TrimBlanks(line.substr(0, mark))));
    const std::string value(TrimBlanks(line.substr(mark + 1)));
    if (section_ == "printer" && key == "max_accel_to_decel") {
      return Set(value, key, number, Range::kAboveZero, accel_to_decel_);
    }
    for (const Setting& setting : kSettings) {
      if (section_ != setting.section || key != setting.key) continue;
      std::optional<double> read;
      const absl::Status status = Set(value, key, number, setting.range, read);
      MachineLimits& into = setting.lowers ? of_axes_ : limits_;
      std::optional<double>& field = into.*setting.field;
      field = setting.lowers && field && read ? std::min(*field, *read) : read;
      return status;
    }
    return absl::OkStatus();
  }

  absl::Status BeginSection(std::string_view line, int number) {
    const size_t end = line.find(']');
    if (end == std::string_view::npos) return Fault(At(name_, number), "a section without a ]");
    section_ = std::string(TrimBlanks(line.substr(1, end - 1)));
    has_printer_ = has_printer_ || section_ == "printer";
    retracts_ = retracts_ || section_ == "firmware_retraction";
    includes_ = includes_ || StartsWith(section_, "include");
    return absl::OkStatus();
  }

  absl::Status Set(const std::string& text, const std::string& key, int number, Range range,
                   std::optional<double>& field) const {
    double value = 0;
    if (!absl::SimpleAtod(text, &value) || !Holds(range, value)) {
      return Fault(At(name_, number),
                   absl::StrFormat("%s: \"%s\" is %s", key, text, NameOf(range)));
    }
    field = value;
    return absl::OkStatus();
  }

  void FillDefaults() {
    const auto fill = [](std::optional<double>& field, double value) {
      if (!field) field = value;
    };
    const auto lower = [](std::optional<double>& field, const std::optional<double>& most) {
      if (most) field = std::min(*field, *most);
    };
    fill(limits_.max_z_speed, *limits_.max_speed);
    fill(limits_.z_accel, *limits_.max_accel);
    lower(limits_.max_speed, of_axes_.max_speed);
    lower(limits_.max_accel, of_axes_.max_accel);
    fill(limits_.corner_speed, 5);
    // The setting of before 2024, which counts with the acceleration of the configuration.
    if (accel_to_decel_) {
      fill(limits_.cruise_ratio, 1 - std::min(1.0, *accel_to_decel_ / *limits_.max_accel));
    }
    fill(limits_.cruise_ratio, 0.5);
    fill(limits_.extruder_corner_speed, 1);
    fill(limits_.arc_chord, 1);
    if (!retracts_) return;  // G10 and G11 are macros, if anything
    fill(limits_.firmware_retract_length, 0);
    fill(limits_.firmware_retract_speed, 20);
    fill(limits_.firmware_prime_speed, 10);
    fill(limits_.firmware_prime_extra, 0);
  }

  const std::string& name_;
  std::string section_;
  bool has_printer_ = false;
  bool includes_ = false;
  bool retracts_ = false;
  std::optional<double> accel_to_decel_;
  MachineLimits of_axes_;  // what one of X and Y may at most
  MachineLimits limits_;
};

// One word of Marlin that is read, in the order in which they count.
struct Word {
  int number;
  char letter;
  Field field;
  Range range = Range::kAboveZero;
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
    {207, 'S', &MachineLimits::firmware_retract_length, Range::kFromZero},
    {207, 'F', &MachineLimits::firmware_retract_speed, Range::kAboveZero, 60},
    {208, 'S', &MachineLimits::firmware_prime_extra, Range::kFromZero},
    {208, 'F', &MachineLimits::firmware_prime_speed, Range::kAboveZero, 60},
    {566, 'X', &MachineLimits::corner_speed, Range::kAboveZero, 60},
    {566, 'Y', &MachineLimits::corner_speed, Range::kAboveZero, 60},
};

class MarlinReader {
 public:
  explicit MarlinReader(const std::string& name) : name_(name) {}

  absl::StatusOr<MachineLimits> Read(std::string_view text) {
    duet_ = text.find("M566") != std::string_view::npos;
    const absl::Status status =
        ForEachLine(text, [this](std::string_view line, int number) { return Take(line, number); });
    if (!status.ok()) return status;
    if (!any_) return Fault(name_, kNeither);
    return limits_;
  }

 private:
  absl::Status Take(std::string_view line, int number) {
    bool said = false;  // by the firmware: it need not be a command
    line = WithoutMarks(line, said);
    Command command;
    LexLine(line, command);
    if (command.kind == LineKind::kText && !said) {
      return Fault(any_ ? At(name_, number) : name_,
                   any_ ? "neither a command nor a comment" : kNeither);
    }
    if (command.Is('G', 20) || command.Is('G', 21)) unit_mm_ = command.number == 20 ? 25.4 : 1;
    const bool ours = command.kind == LineKind::kCommand && command.letter == 'M' &&
                      std::any_of(std::begin(kWords), std::end(kWords),
                                  [&](const Word& word) { return word.number == command.number; });
    // There M208 says how far the axes reach.
    if (!ours || (duet_ && command.number == 208)) return absl::OkStatus();
    if (!ReadWords(command)) {
      return Fault(At(name_, number),
                   absl::StrFormat("M%d: its words cannot be read", command.number));
    }
    any_ = any_ || command.number <= 205;
    return Follow(command, number);
  }

  // Terminals show who said a line, firmware begins what is no answer with `echo:`.
  static std::string_view WithoutMarks(std::string_view line, bool& said) {
    line = TrimBlanks(line);
    for (const std::string_view mark : {"Recv:", "<<<", "<", "Send:", "SENDING:", ">>>", ">"}) {
      if (StartsWith(line, mark)) {
        line = TrimBlanks(line.substr(mark.size()));
        break;
      }
    }
    constexpr std::string_view kEcho = "echo:";
    said = StartsWith(line, kEcho) || line == "ok" || line == "wait" || line == "start";
    return StartsWith(line, kEcho) ? TrimBlanks(line.substr(kEcho.size())) : line;
  }

  absl::Status Follow(const Command& command, int number) {
    for (const Word& word : kWords) {
      if (command.number != word.number || !command.Has(word.letter)) continue;
      const double value = ToDouble(command.Value(word.letter));
      if (!Holds(word.range, value)) {
        return Fault(At(name_, number),
                     absl::StrFormat("M%d %c: %s", word.number, word.letter, NameOf(word.range)));
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
  bool found = false;
  const absl::Status all = ForEachLine(text, [&found](std::string_view line, int) {
    found = found || StartsWith(line, "[");
    return absl::OkStatus();
  });
  return all.ok() && found;
}

}  // namespace

absl::StatusOr<MachineLimits> ReadMachineLimits(std::string_view text, const std::string& name) {
  text = WithoutUtf8Mark(text);
  if (LooksLikeKlipper(text)) return KlipperReader(name).Read(text);
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
    profile.max_accel = kMost;
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
