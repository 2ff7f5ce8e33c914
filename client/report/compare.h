// The table that sets strategies side by side.

#ifndef TRAVERSE_CLIENT_REPORT_COMPARE_H_
#define TRAVERSE_CLIENT_REPORT_COMPARE_H_

#include <string>
#include <vector>

#include "client/report/run.h"

namespace traverse::report {

// One row a strategy: travel in mm (moves to the cleaning point included), split into contours,
// rasters and links; idle time; gain in percent over the order given and over greedy and ni2opt
// where they are among the rows; gap to the proven bound; seconds as the caller waited. Means over
// the runs, with the standard deviation of the travel if there are several. REQUIRES: each strategy
// has a run.
std::string CompareTable(const std::vector<ComparedStrategy>& strategies);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_COMPARE_H_
