// The command line of a program with flags of absl, and the file of --config. Used in place of
// absl's own parser, which ends the process with 1 where a usage error is due and knows the flags
// of all libraries.

#ifndef TRAVERSE_SERVER_OPS_FLAG_READER_H_
#define TRAVERSE_SERVER_OPS_FLAG_READER_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace traverse {

struct FlagProgram {
  std::string name;   // "traverse-server"
  std::string file;   // the end of the path of the source that defines its flags
  std::string usage;  // the text that --help begins with
};

// Sets the flags of `program` to what `arguments` (without the program's name) state, and before
// them the file that --config names. Returns what is to be printed instead of running, for --help
// and --version; else an empty text. InvalidArgument, in one line with its place.
absl::StatusOr<std::string> ReadProgramFlags(const FlagProgram& program,
                                             const std::vector<std::string>& arguments);

// InvalidArgument `--name: what`.
absl::Status BadFlag(const std::string& name, const std::string& what);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_FLAG_READER_H_
