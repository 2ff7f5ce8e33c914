// What a file states about the machine and the slicer's settings, apart from its moves.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_PROFILE_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_PROFILE_H_

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>

#include "client/gcode/machine/interpreter.h"

namespace traverse::gcode {

// Lengths in mm, speeds in mm/s, accelerations in mm/s^2.
struct MachineProfile {
  // Limits and defaults where the file is silent.
  double print_accel = 1250;
  double travel_accel = 1250;
  double retract_accel = 1250;
  double z_accel = 1250;
  double max_z_speed = 1e9;
  double max_e_speed = 1e9;
  double corner_speed = 5;
  double max_speed = 1e9;  // of moves in the plane
  double max_accel = 1e9;  // of them too, whatever the file sets

  // Klipper plans differently (motion_planner.h), has one acceleration for all moves, and limits
  // all axes together. The members below apply to Klipper only.
  bool klipper = false;
  double cruise_ratio = 0;
  double extruder_corner_speed = 0;
  double arc_chord = 1;  // mm

  // G10 and G11 do not say how far and how fast.
  double firmware_retract_length = 1;
  double firmware_retract_speed = 40;
  double firmware_prime_speed = 40;
  double firmware_prime_extra = 0;  // pushed beyond what was pulled back

  // The slicer's own rules, where its configuration is in the file.
  std::optional<double> retract_before_travel;
  std::optional<bool> avoid_crossing;
  std::optional<std::string> top_fill_pattern;
  bool monotonic_bottom = false;  // lines of bottom surfaces are printed in their order
  std::optional<double> nozzle_diameter;
  std::optional<double> clearance_radius;  // around the nozzle, within which parts of the head hang
  std::optional<double> nozzle_height;     // no other part hangs lower above the tip
  double filament_diameter = 1.75;
};

// Reads the lines `; key = value` at the head and at the end of a sliced file (PrusaSlicer,
// SuperSlicer, OrcaSlicer and Slic3r write their whole configuration there).
MachineProfile ReadProfile(std::string_view text);

// Accelerations and corner speed in force, as setters change them.
class Dynamics {
 public:
  explicit Dynamics(const MachineProfile& profile);

  // Follows the setter `line`.
  void Follow(std::string_view line);

  // The same, but only what it sets of `slot`: another setter may hold for the rest.
  void FollowFor(Slot slot, std::string_view line);

  double print_accel() const { return std::min(print_accel_, max_accel_); }
  double travel_accel() const { return std::min(travel_accel_, max_accel_); }
  double corner_speed() const { return corner_speed_; }
  double max_speed() const { return max_speed_; }
  double cruise_ratio() const { return cruise_ratio_; }

 private:
  void FollowKlipper(std::string_view line);

  bool klipper_;
  double print_accel_;
  double travel_accel_;
  double max_accel_;
  double corner_speed_;
  double max_speed_;
  double cruise_ratio_;
};

// Those in force in `state`.
Dynamics DynamicsOf(const MachineProfile& profile, const PrintState& state,
                    const SetterTable& setters);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_MACHINE_PROFILE_H_
