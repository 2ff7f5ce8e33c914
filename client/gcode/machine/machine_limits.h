// What the user says of the machine (--machine), in the words of its firmware:
//
//   a Klipper configuration   [printer], [extruder], [firmware_retraction] and [gcode_arcs] of it;
//                             files that it includes are not read
//   lines of Marlin           M201 to M205, M207 and M208, as in a start script or as M503 lists
//                             them (echo:), in mm or, behind G20, in inches; a terminal's marks
//                             (Recv:, ok) and other commands mean nothing here
//   of RepRapFirmware         the same, known by M566: its speeds are in mm/min

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_LIMITS_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_LIMITS_H_

#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/gcode/machine/machine_profile.h"

namespace traverse::gcode {

// Lengths in mm, speeds in mm/s, accelerations in mm/s^2. Unset: not said.
struct MachineLimits {
  bool klipper = false;  // else Marlin

  std::optional<double> max_speed;
  std::optional<double> max_accel;
  std::optional<double> print_accel;
  std::optional<double> travel_accel;
  std::optional<double> retract_accel;
  std::optional<double> max_z_speed;
  std::optional<double> z_accel;
  std::optional<double> max_e_speed;
  std::optional<double> corner_speed;
  std::optional<double> junction_deviation;  // in place of a corner speed
  std::optional<double> cruise_ratio;
  std::optional<double> extruder_corner_speed;
  std::optional<double> arc_chord;
  std::optional<double> nozzle_diameter;
  std::optional<double> filament_diameter;
  std::optional<double> firmware_retract_length;
  std::optional<double> firmware_retract_speed;
  std::optional<double> firmware_prime_speed;
  std::optional<double> firmware_prime_extra;  // pushed beyond what was pulled back
};

// Reads the text of such a file, whose name errors begin with: `printer.cfg:12: max_accel: ...`.
// What Klipper has a default for has that one.
absl::StatusOr<MachineLimits> ReadMachineLimits(std::string_view text, const std::string& name);

// `profile`, which is what a sliced file states, with what `limits` say in place of that.
void ApplyLimits(const MachineLimits& limits, MachineProfile& profile);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_LIMITS_H_
