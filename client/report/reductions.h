// A table of what the point reductions of the thesis's framework leave.

#ifndef TRAVERSE_CLIENT_REPORT_REDUCTIONS_H_
#define TRAVERSE_CLIENT_REPORT_REDUCTIONS_H_

#include <string>
#include <vector>

#include "client/report/run.h"
#include "client/report/table.h"

namespace traverse::report {

// The rows of thesis tables 5.1 and 5.4: for each strategy that reports them (`tabu`, and `exact`
// with the framework's model), the contour points of a layer before and after each reduction, means
// over layers and runs, with the percentage removed: of all points, for VP of those of SP. A table
// with a title and an empty line before it; empty if no strategy reports reductions.
std::string ReductionTable(const std::vector<ComparedStrategy>& strategies, const TextStyle& style);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REDUCTIONS_H_
