// What a caller requests for a job, beyond what its file says.

#ifndef TRAVERSE_CLIENT_OPTIMIZE_FILE_JOB_SETTINGS_H_
#define TRAVERSE_CLIENT_OPTIMIZE_FILE_JOB_SETTINGS_H_

#include <cstdint>
#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "client/input/input_job.h"
#include "traverse/v1/options.pb.h"

namespace traverse {

// What to minimise. Unset: as the file says.
struct CostSettings {
  std::optional<bool> by_time;
  std::optional<double> speed_mm_s;
  std::optional<double> accel_mm_s2;
  std::optional<double> retraction_seconds;
  std::optional<double> retraction_threshold_mm;
};

// Everything unset is as the file says.
struct JobSettings {
  std::optional<std::pair<uint64_t, uint64_t>> layers;  // positions from 1, both included
  std::optional<v1::Deposition> deposition;
  std::optional<v1::Cleaning> cleaning;
  std::optional<v1::Point> start;
  CostSettings cost;
  std::optional<uint64_t> seed;
  std::optional<absl::Duration> time_limit;
  std::optional<absl::Duration> layer_time_limit;
};

// Keeps only the layers that `settings` select. InvalidArgument if the job has no such layers.
absl::Status SelectLayers(const JobSettings& settings, InputJob& job);

// SelectLayers, then sets the options of the job and its layers as `settings` say.
absl::Status ApplySettings(const JobSettings& settings, InputJob& job);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_OPTIMIZE_FILE_JOB_SETTINGS_H_
