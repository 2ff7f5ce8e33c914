// What a caller wants of G-code.

#ifndef TRAVERSE_CLIENT_GCODE_GCODE_OPTIONS_H_
#define TRAVERSE_CLIENT_GCODE_GCODE_OPTIONS_H_

#include <optional>

#include "client/gcode/machine/machine_limits.h"
#include "client/gcode/plan/policy.h"
#include "client/gcode/work_limit.h"

namespace traverse {

struct GcodeOptions : gcode::Liberties {
  static constexpr double kMostRevisitSeconds = 3600;

  // Replaces what files state about their machine.
  std::optional<gcode::MachineLimits> machine = {};

  gcode::WorkLimit limit = {};  // of reading a file, and of all that is done with it
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_GCODE_OPTIONS_H_
