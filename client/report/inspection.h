// Describes the contents of a file.

#ifndef TRAVERSE_CLIENT_REPORT_INSPECTION_H_
#define TRAVERSE_CLIENT_REPORT_INSPECTION_H_

#include <string>

#include "client/api/job_result.h"
#include "client/input/input_job.h"

namespace traverse::report {

// Format, layers, islands, paths by kind or feature, points, and the travel of the given order,
// taken from `given` (a run of the strategy none); then one row per layer, if there are at most
// `max_rows`.
std::string InspectionText(const InputJob& job, const JobResult& given, size_t max_rows);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_INSPECTION_H_
