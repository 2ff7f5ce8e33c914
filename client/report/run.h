// Runs of a job, from which reports are made.

#ifndef TRAVERSE_CLIENT_REPORT_RUN_H_
#define TRAVERSE_CLIENT_REPORT_RUN_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "client/api/job_result.h"

namespace traverse::report {

// One run of a job.
struct JobRun {
  JobResult result;
  uint64_t seed = 1;
  double wall_seconds = 0;  // as the caller waited

  // How many layers the service left without an answer, so that they are greedy's, and why.
  size_t missed_layers = 0;
  absl::Status missed_because = absl::OkStatus();
};

// The runs of one strategy, which differ only in their seeds; at least one.
struct ComparedStrategy {
  std::string label;  // as the user wrote it: "tabu:polish=false"
  std::vector<JobRun> runs;
};

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_RUN_H_
