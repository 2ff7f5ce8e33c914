// The tables of Weller (2019), ours beside the thesis's own.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_TABLES_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_TABLES_H_

#include <functional>
#include <string>

#include "client/report/reproduce/outcomes.h"
#include "client/report/reproduce/run_plan.h"

namespace traverse::report {

// The outcome of a run; null if it was not run.
using OutcomeOfRun = std::function<const RunOutcome*(const PlannedRun&)>;

// Head speed of [T] 3.4 for idle times, mm/s.
inline constexpr double kIdleSpeed = 20.32;

// Tables 3.1 and 3.2, 5.1 to 5.8, and the figures of 5.13, with the thesis's rows and words; lines
// marked "tese" have the thesis's own figures. Leaves out what was not run.
std::string ThesisTables(const ReproduceForm& form, const OutcomeOfRun& outcome);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_THESIS_TABLES_H_
