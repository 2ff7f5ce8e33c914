// The command line of traverse-loadgen.

#ifndef TRAVERSE_CLIENT_LOADGEN_LOADGEN_FLAGS_H_
#define TRAVERSE_CLIENT_LOADGEN_LOADGEN_FLAGS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/api/channel.h"
#include "client/cli/flags/flags.h"
#include "client/loadgen/load_plan.h"
#include "client/loadgen/load_run.h"
#include "traverse/v1/options.pb.h"

namespace traverse::loadgen {

// The values of the flags, checked.
struct LoadgenFlags {
  std::vector<std::string> target;  // addresses, HOST:PORT
  ConnectOptions connect;
  LoadOptions load;
  std::vector<SizeShare> mix;
  v1::JobOptions job;
  std::string strategy;  // as written
  std::string input;     // file whose layers are sent; empty: generated
  int islands = 10;      // of a generated layer
  int connections = 1;
  std::string json;  // file; empty: none
};

const std::vector<cli::Flag>& LoadgenFlagTable();

// What --help prints.
std::string LoadgenHelp();

// InvalidArgument, with the flag's name and the fault in its value.
absl::StatusOr<LoadgenFlags> ParseLoadgenFlags(const std::vector<std::string>& arguments);

}  // namespace traverse::loadgen

#endif  // TRAVERSE_CLIENT_LOADGEN_LOADGEN_FLAGS_H_
