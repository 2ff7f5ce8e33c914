// The machine as the user describes it (--machine), in the terms of its firmware:
//
//   a Klipper configuration   its sections [printer], [extruder], [firmware_retraction] and
//                             [gcode_arcs], and those of files that it includes
//   lines of Marlin           M201 to M205, M207 and M208, as in a start script or as M503 prints
//                             them (echo:), in mm or, after G20, in inches; the marks of a
//                             terminal (Recv:, ok) and other commands are ignored
//   of RepRapFirmware         the same, recognised by M566: its speeds are in mm/min

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_LIMITS_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_LIMITS_H_

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace traverse::gcode {

struct MachineProfile;

// Lengths in mm, speeds in mm/s, accelerations in mm/s^2. Unset: not stated.
struct MachineLimits {
  bool klipper = false;  // otherwise Marlin

  std::optional<double> max_speed;
  std::optional<double> max_accel;
  std::optional<double> print_accel;
  std::optional<double> travel_accel;
  std::optional<double> retract_accel;
  std::optional<double> max_z_speed;
  std::optional<double> z_accel;
  std::optional<double> max_e_speed;
  std::optional<double> corner_speed;
  std::optional<double> junction_deviation;  // instead of a corner speed
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

// A file that a configuration includes: its name, for errors and its own includes, and its text.
struct IncludedFile {
  std::string name;
  std::string text;
};

// The files that `[include PATTERN]` in the file `from` means, in their order. A pattern without
// wildcards that means no file is an error.
using ReadIncludes = std::function<absl::StatusOr<std::vector<IncludedFile>>(
    const std::string& pattern, const std::string& from)>;

// Reads the text of such a file. Errors begin with its name and line: `printer.cfg:12: max_accel:
// ...`. Values that the file omits and Klipper has a default for get that default. Without
// `includes`, files that it includes are not read.
absl::StatusOr<MachineLimits> ReadMachineLimits(std::string_view text, const std::string& name,
                                                const ReadIncludes& includes = {});

// `profile`, as a sliced file states it, overridden by `limits`.
void ApplyLimits(const MachineLimits& limits, MachineProfile& profile);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_LIMITS_H_
