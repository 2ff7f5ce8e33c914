// The table that compares strategies.

#ifndef TRAVERSE_CLIENT_REPORT_COMPARE_H_
#define TRAVERSE_CLIENT_REPORT_COMPARE_H_

#include <string>
#include <vector>

#include "client/report/run.h"
#include "client/report/table.h"
#include "traverse/v1/options.pb.h"

namespace traverse::report {

// Width of a table that is not on a terminal.
inline constexpr int kPageWidth = 132;

// What strategies are compared by.
enum class CompareBy {
  kLength,  // travel in mm
  kTime,    // what travel takes, in s: jobs whose cost is a time
};

// One row per strategy: travel in mm (including moves to the cleaning point), split into contours,
// rasters and links; idle time; gain in percent over the given order, and over greedy and ni2opt if
// they are among the rows; gap to the proven bound; seconds for which the caller waited; a bar for
// the gain over the given order, which would be full without any travel. Means over the runs, with
// the standard deviation of the travel if there are several. The shortest travel is colored. If
// style.width is small, the bar goes first, then labels are folded, then the idle time goes, then
// the split. With CompareBy::kTime the seconds of travel, with its retractions, come first; gains,
// deviation and color are theirs, and idle time, which is their part at speed, is left out.
// REQUIRES: each strategy has a run.
std::string CompareTable(const std::vector<ComparedStrategy>& strategies, const TextStyle& style,
                         CompareBy by = CompareBy::kLength);

// By which strategies are compared on jobs with these options.
CompareBy CompareByOf(const v1::JobOptions& options);

// That of a run: less is better.
double ComparedValue(const JobRun& run, CompareBy by);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_COMPARE_H_
