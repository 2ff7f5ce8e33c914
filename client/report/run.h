// Runs of a job: what reports are made of.

#ifndef TRAVERSE_CLIENT_REPORT_RUN_H_
#define TRAVERSE_CLIENT_REPORT_RUN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "client/api/job_result.h"

namespace traverse::report {

// One run of a job.
struct JobRun {
  JobResult result;
  uint64_t seed = 1;
  double wall_seconds = 0;  // as the caller saw it
};

// The runs of one strategy, which differ in their seeds alone; at least one.
struct ComparedStrategy {
  std::string label;  // as the user wrote it: "tabu:polish=false"
  std::vector<JobRun> runs;
};

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_RUN_H_
