// The table that sets strategies side by side.

#ifndef TRAVERSE_CLIENT_REPORT_COMPARE_H_
#define TRAVERSE_CLIENT_REPORT_COMPARE_H_

#include <string>
#include <vector>

#include "client/report/run.h"
#include "client/report/table.h"

namespace traverse::report {

// Columns that a table without a terminal is made for.
inline constexpr int kPageWidth = 132;

// One row a strategy: travel in mm (moves to the cleaning point included), split into contours,
// rasters and links; idle time; gain in percent over the order given and over greedy and ni2opt
// where they are among the rows; gap to the proven bound; seconds as the caller waited; a bar for
// the gain over the order given, of which a full one would be no travel at all. Means over the
// runs, with the standard deviation of the travel if there are several. The shortest travel is
// marked in color. Where style.width is short the bar is left out first, labels are folded, then
// the idle time is left out, then the split. REQUIRES: each strategy has a run.
std::string CompareTable(const std::vector<ComparedStrategy>& strategies, const TextStyle& style);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_COMPARE_H_
