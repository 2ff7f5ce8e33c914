// From a file to a job, whatever its format.

#ifndef TRAVERSE_CLIENT_FORMATS_READ_INPUT_H_
#define TRAVERSE_CLIENT_FORMATS_READ_INPUT_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/gcode/gcode_job.h"
#include "client/input/input_job.h"

namespace traverse {

// Reads the file `name` ("-": standard input), decompresses it if it is gzip or xz, recognises its
// format by content, then by extension, and reads that. Errors are one line that begins with the
// name, with the line number where the format has lines. `gcode` says what G-code is read for.
absl::StatusOr<InputJob> ReadInput(const std::string& name, const GcodeOptions& gcode = {});

// The same from the file's bytes.
absl::StatusOr<InputJob> ParseInput(std::string bytes, const std::string& name,
                                    const GcodeOptions& gcode = {});

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FORMATS_READ_INPUT_H_
