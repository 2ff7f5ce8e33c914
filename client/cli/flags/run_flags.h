// The flags that `optimize` and `compare` share: what to run, and what to write.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_RUN_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_RUN_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/cli/flags/flags.h"
#include "client/cli/flags/job_flags.h"
#include "client/cli/flags/view_flags.h"

namespace traverse::cli {

struct RunFlags {
  JobFlags job;
  ViewFlags views;
  std::string json;  // a file, or - for standard output; empty: none
  bool quiet = false;
};

// `own`, the flags of one command, followed by the rows of these.
std::vector<Flag> WithRunFlagTable(std::vector<Flag> own);

// InvalidArgument, with the flag's name.
absl::StatusOr<RunFlags> ParseRunFlags(const Flags& flags);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_RUN_FLAGS_H_
