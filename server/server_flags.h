// The flags of traverse-server.

#ifndef TRAVERSE_SERVER_SERVER_FLAGS_H_
#define TRAVERSE_SERVER_SERVER_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "server/server.h"

namespace traverse {

// Reads the command line, without the program's name. Before that it reads the file that --config
// names, so that the command line wins. Returns the text to print instead of serving, for --help
// and --version; otherwise an empty text. InvalidArgument, in one line, for any mistake, such as
// `unknown flag --thread; ...`, `server.conf:3: unknown flag --thread; ...` or `--threads: -1 is
// below 0`.
absl::StatusOr<std::string> ReadFlags(const std::vector<std::string>& arguments);

// The options that the flags state, after ReadFlags.
ServerOptions OptionsFromFlags();

// Of what the limit of open files leaves room for less than a flag says, in words; empty: of
// nothing.
std::string FewFiles();

absl::Duration DrainTimeout();

}  // namespace traverse

#endif  // TRAVERSE_SERVER_SERVER_FLAGS_H_
