// The flags of all commands that run jobs, and their effect on a job's options.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_JOB_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_JOB_FLAGS_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/cli/flags/flags.h"
#include "client/gcode/gcode_options.h"
#include "client/optimize_file/job_settings.h"

namespace traverse {
struct InputJob;
}

namespace traverse::cli {

// The values of the flags, checked; unset: not given.
struct JobFlags : JobSettings {
  std::vector<std::pair<std::string, std::string>> strategy_options;  // --option
  absl::Duration deadline = absl::InfiniteDuration();
};

// The rows of these flags.
std::vector<Flag> JobFlagTable();

// The rows of the flags that say where the service runs and how to reach it: --server, --threads
// and those of connection_flags.h.
std::vector<Flag> ServiceFlagTable();

// The rows of --policy, --crossings and --allow, and their values for the reader of G-code.
Flag PolicyFlag();
Flag CrossingsFlag();
Flag AllowFlag();
Flag MaxHiddenTravelFlag();

// The row of --machine.
Flag MachineFlag();

// InvalidArgument for unknown names in --allow, and if the file of --machine cannot be
// read.
absl::StatusOr<GcodeOptions> ParseGcodeOptions(const Flags& flags);

absl::StatusOr<JobFlags> ParseJobFlags(const Flags& flags);

// Keeps only the layers that --layers selects. InvalidArgument if the job has none of them.
absl::Status SelectJobLayers(const JobFlags& flags, InputJob& job);

// SelectJobLayers, then sets the options of the job and its layers as the flags say.
absl::Status ApplyJobFlags(const JobFlags& flags, InputJob& job);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_JOB_FLAGS_H_
