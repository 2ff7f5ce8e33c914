// The command line of a program with flags of absl, and the file of --config. Used in place of
// absl's own parser, which ends the process with 1 where a usage error is due and knows the flags
// of all libraries.

#ifndef TRAVERSE_SERVER_OPS_FLAG_READER_H_
#define TRAVERSE_SERVER_OPS_FLAG_READER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace traverse {

struct FlagProgram {
  std::string name;   // "traverse-server"
  std::string file;   // the end of the path of the source that defines its flags
  std::string usage;  // the text that --help begins with

  // InvalidArgument if the flags, which are set, do not go together or are out of range.
  absl::Status (*check)();
};

// Sets the flags of `program` to what `arguments` (without the program's name) state, and before
// them the file that --config names. Returns what is to be printed instead of running, for --help
// and --version; else an empty text. Errors: InvalidArgument in one line with its place; that of
// `check`.
absl::StatusOr<std::string> ReadProgramFlags(const FlagProgram& program,
                                             const std::vector<std::string>& arguments);

// A flag that is a number with a least value.
struct LeastValue {
  const char* name;
  int64_t value;
  int64_t least;
};

// InvalidArgument `--name: -1 is below 0` for the first that is below.
absl::Status CheckLeastValues(const std::vector<LeastValue>& numbers);

// InvalidArgument if --drain_timeout is below 0, or --allowed_clients is given without
// --tls_client_ca: flags that each daemon has.
absl::Status CheckDaemonFlags(absl::Duration drain_timeout,
                              const std::vector<std::string>& allowed_clients,
                              const std::string& tls_client_ca);

// InvalidArgument `--name: what`.
absl::Status BadFlag(const std::string& name, const std::string& what);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_FLAG_READER_H_
