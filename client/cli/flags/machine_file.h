// The file that --machine names.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_MACHINE_FILE_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_MACHINE_FILE_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/gcode/machine/machine_limits.h"

namespace traverse::cli {

// Reads the limits in the file `name` ("-": standard input) and in those that it includes, which
// are sought beside it, as Klipper does. Errors begin with the name of the file that they are
// about.
absl::StatusOr<gcode::MachineLimits> ReadMachineFile(const std::string& name);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_MACHINE_FILE_H_
