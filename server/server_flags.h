// The flags of traverse-server.

#ifndef TRAVERSE_SERVER_SERVER_FLAGS_H_
#define TRAVERSE_SERVER_SERVER_FLAGS_H_

#include <string>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "server/server.h"

namespace traverse {

// Reads the command line, and first the file that --config names, so that the command line wins.
// Ends the process for --help, --version and unknown flags. InvalidArgument for everything else
// that is wrong, such as `server.conf:3: no flag "thread"` or `--threads: -1 is below 0`.
absl::Status ReadFlags(int argc, char** argv);

// What the flags say, after ReadFlags.
ServerOptions OptionsFromFlags();

absl::Duration DrainTimeout();

// Sets the flags that the lines `name=value` of a file state; `#` begins a comment line.
// InvalidArgument with the line.
absl::Status ReadConfigFile(const std::string& path);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_SERVER_FLAGS_H_
