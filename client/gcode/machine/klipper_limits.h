// The limits that a Klipper configuration states; see machine_limits.h.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_KLIPPER_LIMITS_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_KLIPPER_LIMITS_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "client/gcode/machine/machine_limits.h"

namespace traverse::gcode {

// As ReadMachineLimits, for a text that is such a configuration.
absl::StatusOr<MachineLimits> ReadKlipperLimits(std::string_view text, const std::string& name,
                                                const ReadIncludes& includes);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_KLIPPER_LIMITS_H_
