#include "client/gcode/machine/machine_profile.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/dialects/dialect.h"
#include "client/gcode/text/cura_settings.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

// Configurations are some 20 KiB; OrcaSlicer's with its embedded scripts 100 KiB.
constexpr size_t kScanBytes = size_t{256} << 10;

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
    const std::optional<double> number = LeadingNumber(polygon.substr(at, end - at));
    if (!number) return std::nullopt;
    if (x) reach = std::max(reach.value_or(0), std::hypot(*x, *number));
    x = x ? std::nullopt : number;
    at = polygon.find_first_of(kOfNumber, end);
  }
  return reach;
}

void Apply(Setting setting, std::string_view value, MachineProfile& profile) {
  const std::optional<double> number = LeadingNumber(value);  // the first of `9000,1000` or `1.5;2`
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
      profile.monotonic_bottom = value.starts_with("monotonic");
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

// The lines `; key = value` of a part of a file.
void ApplySettings(std::string_view part, MachineProfile& profile) {
  for (Offset next = 0; next < part.size();) {
    const Line at = LineAt(part, next);
    next = at.next;
    const std::string_view line = at.Text(part);
    const size_t equals = line.find(" = ");
    if (!line.starts_with(';') || equals == std::string_view::npos) continue;
    const auto setting = SettingOf(TrimBlanks(line.substr(1, equals - 1)));
    if (setting) Apply(*setting, TrimBlanks(line.substr(equals + 3)), profile);
  }
}

// The number behind `name` in a Klipper command.
std::optional<double> Parameter(std::string_view line, std::string_view name) {
  const size_t at = line.find(name);
  if (at == std::string_view::npos) return std::nullopt;
  return LeadingNumber(line.substr(at + name.size()));
}

// CuraEngine's, in the joined text of all its settings.
void ApplyCura(const std::string& joined, MachineProfile& profile) {
  for (const SettingWord& word : kCura.settings) {
    const size_t at = joined.find(word.key);
    if (at == joined.npos) continue;
    const std::string_view rest = std::string_view(joined).substr(at + word.key.size());
    const std::string_view line = rest.substr(0, rest.find('\\'));
    if (line.starts_with(" = ")) Apply(word.setting, line.substr(3), profile);
  }
}

}  // namespace

MachineProfile ReadProfile(std::string_view text) {
  MachineProfile profile;
  ApplySettings(text.substr(0, kScanBytes), profile);
  if (text.size() > kScanBytes) {
    ApplySettings(text.substr(std::max(kScanBytes, text.size() - kScanBytes)), profile);
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
    if (command.number != 204) return;
    // It takes S, or the smaller of P and T; it ignores one of these by itself.
    std::optional<double> accel = value('S');
    if (!accel && command.Has('P') && command.Has('T')) accel = std::min(value('P'), value('T'));
    SetPositive(print_accel_, accel);
    SetPositive(travel_accel_, accel);
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
  struct SlotValue {
    Slot slot;
    double Dynamics::*value;
  };
  static constexpr SlotValue kValues[] = {
      {kSlotPrintAccel, &Dynamics::print_accel_},     {kSlotTravelAccel, &Dynamics::travel_accel_},
      {kSlotKlipperAccel, &Dynamics::print_accel_},   {kSlotKlipperAccel, &Dynamics::travel_accel_},
      {kSlotMaxAccelX, &Dynamics::max_accel_},        {kSlotJerkX, &Dynamics::corner_speed_},
      {kSlotKlipperCorner, &Dynamics::corner_speed_}, {kSlotKlipperSpeed, &Dynamics::max_speed_},
      {kSlotKlipperDecel, &Dynamics::cruise_ratio_}};
  Dynamics after = *this;
  after.Follow(line);
  for (const SlotValue& of : kValues) {
    if (of.slot == slot) this->*of.value = after.*of.value;
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
