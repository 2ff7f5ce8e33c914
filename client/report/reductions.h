// What the point reductions of the thesis's framework leave, as a table.

#ifndef TRAVERSE_CLIENT_REPORT_REDUCTIONS_H_
#define TRAVERSE_CLIENT_REPORT_REDUCTIONS_H_

#include <string>
#include <vector>

#include "client/report/run.h"
#include "client/report/table.h"

namespace traverse::report {

// The rows of thesis tables 5.1 and 5.4: for each strategy that tells of it (`tabu`, `exact` with
// the model of the framework), the contour points of a layer before and after each reduction, means
// over layers and runs, with the percent that are gone: of all points; for VP of those of SP. A
// table with a title and an empty line before it; empty if no strategy tells of reductions.
std::string ReductionTable(const std::vector<ComparedStrategy>& strategies, const TextStyle& style);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REDUCTIONS_H_
