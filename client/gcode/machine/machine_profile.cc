#include "client/gcode/machine/machine_profile.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "client/gcode/dialects/dialect.h"
#include "client/gcode/text/cura_settings.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// Configurations are some 20 KiB; OrcaSlicer's with its embedded scripts 100 KiB.
constexpr size_t kScanBytes = size_t{256} << 10;

using SettingLine = std::function<void(std::string_view key, std::string_view value)>;

void ForEachSetting(std::string_view part, const SettingLine& setting) {
  for (size_t begin = 0; begin < part.size();) {
    const size_t end = std::min(part.find('\n', begin), part.size());
    const std::string_view line = part.substr(begin, end - begin);
    begin = end + 1;
    if (line.size() < 2 || line[0] != ';') continue;
    const size_t equals = line.find(" = ");
    if (equals == std::string_view::npos) continue;
    setting(TrimBlanks(line.substr(1, equals - 1)), TrimBlanks(line.substr(equals + 3)));
  }
}

// The first of the numbers in `9000,1000` or `1.5;2`; nothing if it is none, or not finite.
std::optional<double> FirstNumber(std::string_view value) {
  const char* p = value.data();
  const std::optional<Decimal> number = ParseDecimal(&p, value.data() + value.size());
  if (!number) return std::nullopt;
  return ToDouble(*number);
}

void SetPositive(double& field, std::optional<double> value) {
  if (value && *value > 0) field = *value;
}

// Of a part of the head.
void SetLength(std::optional<double>& field, std::optional<double> value) {
  constexpr double kMostMm = 100;
  if (value && *value > 0 && *value <= kMostMm) field = value;
}

// How far from the nozzle the farthest corner of `[[-20, 10], [10, 10], [10, -10]]` is.
std::optional<double> ReachOf(std::string_view polygon) {
  constexpr std::string_view kOfNumber = "+-.0123456789";
  std::optional<double> reach;
  std::optional<double> x;
  for (size_t at = polygon.find_first_of(kOfNumber); at != polygon.npos;) {
    const size_t end = std::min(polygon.find_first_not_of(kOfNumber, at), polygon.size());
    const std::optional<double> number = FirstNumber(polygon.substr(at, end - at));
    if (!number) return std::nullopt;
    if (x) reach = std::max(reach.value_or(0), std::hypot(*x, *number));
    x = x ? std::nullopt : number;
    at = polygon.find_first_of(kOfNumber, end);
  }
  return reach;
}

void Apply(Setting setting, std::string_view value, MachineProfile& profile) {
  const std::optional<double> number = FirstNumber(value);
  switch (setting) {
    case Setting::kPrintAccel:
      return SetPositive(profile.print_accel, number);
    case Setting::kTravelAccel:
      return SetPositive(profile.travel_accel, number);
    case Setting::kRetractAccel:
      return SetPositive(profile.retract_accel, number);
    case Setting::kZAccel:
      return SetPositive(profile.z_accel, number);
    case Setting::kMaxZSpeed:
      return SetPositive(profile.max_z_speed, number);
    case Setting::kMaxESpeed:
      return SetPositive(profile.max_e_speed, number);
    case Setting::kRetractLength:
      return SetPositive(profile.firmware_retract_length, number);
    case Setting::kRetractSpeed:
      SetPositive(profile.firmware_retract_speed, number);
      profile.firmware_prime_speed = profile.firmware_retract_speed;
      return;
    case Setting::kRetractBeforeTravel:
      profile.retract_before_travel = number;
      return;
    case Setting::kAvoidCrossing:
      profile.avoid_crossing = value == "1";
      return;
    case Setting::kTopFillPattern:
      profile.top_fill_pattern = std::string(value);
      return;
    case Setting::kBottomFillPattern:
      profile.monotonic_bottom = StartsWith(value, "monotonic");
      return;
    case Setting::kNozzleDiameter:
      profile.nozzle_diameter = number;
      return;
    case Setting::kClearanceRadius:
      return SetLength(profile.clearance_radius, number);
    case Setting::kHeadPolygon:
      return SetLength(profile.clearance_radius, ReachOf(value));
    case Setting::kNozzleHeight:
      return SetLength(profile.nozzle_height, number);
    case Setting::kFilamentDiameter:
      return SetPositive(profile.filament_diameter, number);
  }
}

// The number behind `name` in a Klipper command.
std::optional<double> Parameter(std::string_view line, std::string_view name) {
  const size_t at = line.find(name);
  if (at == std::string_view::npos) return std::nullopt;
  return FirstNumber(line.substr(at + name.size()));
}

// CuraEngine's, in the joined text of all its settings.
void ApplyCura(const std::string& joined, MachineProfile& profile) {
  for (const SettingWord& word : kCura.settings) {
    const size_t at = joined.find(word.key);
    if (at == joined.npos) continue;
    const std::string_view rest = std::string_view(joined).substr(at + word.key.size());
    const std::string_view line = rest.substr(0, rest.find('\\'));
    if (StartsWith(line, " = ")) Apply(word.setting, line.substr(3), profile);
  }
}

}  // namespace

MachineProfile ReadProfile(std::string_view text) {
  MachineProfile profile;
  const SettingLine apply = [&profile](std::string_view key, std::string_view value) {
    if (const std::optional<Setting> setting = SettingOf(key)) Apply(*setting, value, profile);
  };
  ForEachSetting(text.substr(0, kScanBytes), apply);
  if (text.size() > kScanBytes) {
    ForEachSetting(text.substr(std::max(kScanBytes, text.size() - kScanBytes)), apply);
  }
  ApplyCura(JoinedCuraSettings(text), profile);
  return profile;
}

Dynamics::Dynamics(const MachineProfile& profile)
    : klipper_(profile.klipper),
      print_accel_(profile.print_accel),
      travel_accel_(profile.travel_accel),
      max_accel_(profile.max_accel),
      corner_speed_(profile.corner_speed),
      max_speed_(profile.max_speed),
      cruise_ratio_(profile.cruise_ratio) {}

void Dynamics::Follow(std::string_view line) {
  Command command;
  LexLine(line, command);
  if (command.kind == LineKind::kText) return FollowKlipper(line);
  if (command.kind != LineKind::kCommand || command.letter != 'M' || !ReadWords(command)) return;
  const auto value = [&command](char letter) -> std::optional<double> {
    if (!command.Has(letter)) return std::nullopt;
    return ToDouble(command.Value(letter));
  };
  if (klipper_) {
    if (command.number == 204) FollowKlipperAccel(value('S'), value('P'), value('T'));
  } else if (command.number == 204) {
    SetPositive(print_accel_, value('S'));
    SetPositive(travel_accel_, value('S'));
    SetPositive(print_accel_, value('P'));
    SetPositive(travel_accel_, value('T'));
  } else if (command.number == 201) {
    SetPositive(max_accel_, value('X'));
  } else if (command.number == 205 || command.number == 207) {
    SetPositive(corner_speed_, value('X'));
  } else if (command.number == 566 && command.Has('X')) {
    SetPositive(corner_speed_, *value('X') / 60);
  }
}

void Dynamics::FollowFor(Slot slot, std::string_view line) {
  Dynamics after = *this;
  after.Follow(line);
  switch (slot) {
    case kSlotPrintAccel:
      print_accel_ = after.print_accel_;
      break;
    case kSlotTravelAccel:
      travel_accel_ = after.travel_accel_;
      break;
    case kSlotKlipperAccel:
      print_accel_ = after.print_accel_;
      travel_accel_ = after.travel_accel_;
      break;
    case kSlotMaxAccelX:
      max_accel_ = after.max_accel_;
      break;
    case kSlotJerkX:
    case kSlotKlipperCorner:
      corner_speed_ = after.corner_speed_;
      break;
    case kSlotKlipperSpeed:
      max_speed_ = after.max_speed_;
      break;
    case kSlotKlipperDecel:
      cruise_ratio_ = after.cruise_ratio_;
      break;
    default:
      break;
  }
}

void Dynamics::FollowKlipper(std::string_view line) {
  SetPositive(print_accel_, Parameter(line, " ACCEL="));
  SetPositive(travel_accel_, Parameter(line, " ACCEL="));
  SetPositive(corner_speed_, Parameter(line, " SQUARE_CORNER_VELOCITY="));
  if (!klipper_) return;
  SetPositive(max_speed_, Parameter(line, " VELOCITY="));
  // ACCEL_TO_DECEL said the same to Klipper before 2024, which ignores it since.
  const std::optional<double> ratio = Parameter(line, " MINIMUM_CRUISE_RATIO=");
  if (ratio && *ratio >= 0 && *ratio < 1) cruise_ratio_ = *ratio;
}

// Klipper takes S, or the smaller of P and T; it ignores one of these by itself.
void Dynamics::FollowKlipperAccel(std::optional<double> all, std::optional<double> print,
                                  std::optional<double> travel) {
  if (!all && print && travel) all = std::min(*print, *travel);
  SetPositive(print_accel_, all);
  SetPositive(travel_accel_, all);
}

Dynamics DynamicsOf(const MachineProfile& profile, const PrintState& state,
                    const SetterTable& setters) {
  Dynamics dynamics(profile);
  for (size_t slot = 0; slot < kSlotCount; ++slot) {
    if (((kDynamicsSlots >> slot) & 1u) == 0 || state[slot] == 0) continue;
    dynamics.FollowFor(static_cast<Slot>(slot), setters.Line(state[slot]));
  }
  return dynamics;
}

}  // namespace traverse::gcode
