// The flags of all commands that run jobs, and what they make of a job's options.

#ifndef TRAVERSE_CLIENT_CLI_JOB_FLAGS_H_
#define TRAVERSE_CLIENT_CLI_JOB_FLAGS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/time/time.h"
#include "client/cli/flags.h"
#include "client/gcode/gcode_job.h"
#include "client/input/input_job.h"
#include "traverse/v1/options.pb.h"

namespace traverse::cli {

// What is minimised, as far as flags say.
struct CostFlags {
  std::optional<bool> by_time;  // --cost
  std::optional<double> speed_mm_s;
  std::optional<double> accel_mm_s2;
  std::optional<double> retraction_seconds;
  std::optional<double> retraction_threshold_mm;
};

// The values of the flags, checked; nothing: not given.
struct JobFlags {
  std::vector<std::pair<std::string, std::string>> strategy_options;  // --option
  std::optional<std::pair<uint64_t, uint64_t>> layers;  // positions from 1, both included
  std::optional<v1::Deposition> deposition;
  std::optional<v1::Cleaning> cleaning;
  std::optional<v1::Point> start;
  CostFlags cost;
  std::optional<uint64_t> seed;
  std::optional<absl::Duration> time_limit;  // no flag sets it
  std::optional<absl::Duration> layer_time_limit;
  absl::Duration deadline = absl::InfiniteDuration();
};

// The rows of these flags.
std::vector<Flag> JobFlagTable();

// The rows of the flags that say where the service runs and how it is reached: --server,
// --threads and those of connection_flags.h.
std::vector<Flag> ServiceFlagTable();

// The row of --policy, and what it says to the reader of G-code.
Flag PolicyFlag();
GcodeOptions ParseGcodeOptions(const Flags& flags);

absl::StatusOr<JobFlags> ParseJobFlags(const Flags& flags);

// Leaves the layers that --layers selects. InvalidArgument if the job has no such layers.
absl::Status SelectLayers(const JobFlags& flags, InputJob& job);

// SelectLayers, then changes the job's and its layers' options to what the flags say.
absl::Status ApplyJobFlags(const JobFlags& flags, InputJob& job);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_JOB_FLAGS_H_
