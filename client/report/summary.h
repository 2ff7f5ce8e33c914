// The result of a job, in words.

#ifndef TRAVERSE_CLIENT_REPORT_SUMMARY_H_
#define TRAVERSE_CLIENT_REPORT_SUMMARY_H_

#include <string>

#include "client/gcode/choose/chosen_layers.h"
#include "client/input/input_job.h"
#include "client/report/run.h"

namespace traverse::report {

// A few lines: travel before and after, idle time saved, gap if known, why the search ended. With
// the `forecast` of a file that was written, the cost is that of its orders, and what the search
// took for travel is left out: the file has what was measured (DescribeRewrite).
std::string OptimizeSummary(const InputJob& job, const JobRun& run,
                            const gcode::Forecast* forecast = nullptr);

// Gap of the whole job in percent, as "0.8 %", or "" if no bound is known.
std::string GapText(const v1::JobSummary& summary);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_SUMMARY_H_
