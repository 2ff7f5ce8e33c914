// What a file states about how far its print is, where that cannot be true.

#ifndef TRAVERSE_CLIENT_GCODE_STATED_PROGRESS_H_
#define TRAVERSE_CLIENT_GCODE_STATED_PROGRESS_H_

#include <string>
#include <vector>

#include "client/gcode/model/gcode_file.h"

namespace traverse {

// A line for each: shares in M73 that go back, and shares that are far from the share of the print
// time, at the stated speeds, that is over: "M73 states 66 % at 33 % of the print time in
// part.gcode:118; ...". Both are kept as they are.
std::vector<std::string> DescribeProgressFaults(const GcodeFile& file);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_STATED_PROGRESS_H_
