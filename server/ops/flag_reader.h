// The command line of a program with absl flags, and the file of --config. Replaces absl's
// own parser, which exits with 1 where a usage error is due and knows the flags of all
// libraries.

#ifndef TRAVERSE_SERVER_OPS_FLAG_READER_H_
#define TRAVERSE_SERVER_OPS_FLAG_READER_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/time/time.h"

namespace traverse {

struct FlagProgram {
  std::string name;   // "traverse-server"
  std::string file;   // the end of the path of the source file that defines its flags
  std::string usage;  // the text with which --help begins

  // InvalidArgument if the flags, as set, contradict each other or are out of range.
  absl::Status (*check)();
};

// Sets the flags of `program` from `arguments` (without the program's name), and before that from
// the file that --config names. Returns the text to print instead of running, for --help and
// --version; otherwise an empty text. Errors: InvalidArgument in one line that says where; those of
// `check`.
absl::StatusOr<std::string> ReadProgramFlags(const FlagProgram& program,
                                             const std::vector<std::string>& arguments);

// A flag that is a number with a minimum.
struct LeastValue {
  const char* name;
  int64_t value;
  int64_t least;
};

// InvalidArgument `--name: -1 is below 0` for the first number that is too small.
absl::Status CheckLeastValues(const std::vector<LeastValue>& numbers);

// InvalidArgument if --drain_timeout is below 0, or --allowed_clients is given without
// --tls_client_ca. Every daemon has these flags.
absl::Status CheckDaemonFlags(absl::Duration drain_timeout,
                              const std::vector<std::string>& allowed_clients,
                              const std::string& tls_client_ca);

// InvalidArgument `--name: what`.
// CALLER=WEIGHT, weights above 0 and no more than 1000. InvalidArgument that names the entry.
absl::StatusOr<std::map<std::string, double>> ParseWeights(const std::vector<std::string>& flag);

absl::Status BadFlag(const std::string& name, const std::string& what);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_OPS_FLAG_READER_H_
