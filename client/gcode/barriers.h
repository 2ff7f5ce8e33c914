// What keeps paths of a sliced file where they are, in words of a person who slices, and what would
// let them move: a flag, or a setting of the slicer.

#ifndef TRAVERSE_CLIENT_GCODE_BARRIERS_H_
#define TRAVERSE_CLIENT_GCODE_BARRIERS_H_

#include <cstddef>
#include <string>
#include <vector>

#include "client/gcode/model/gcode_file.h"
#include "client/gcode/plan/policy.h"

namespace traverse {

inline constexpr size_t kMostBarriers = 3;

// The kMostBarriers weightiest ones of the layers for which `counted` is true, though other orders
// were looked for there; or of all, before that, if it is empty; by the number of paths that each
// keeps from others, a line for each: "120 paths in 12 layers are cut off by ... (first in
// part.gcode:118); --allow=fan_order lets them move"; and, if there is room for it, what else no
// order found is faster for, or must be kept.
std::vector<std::string> DescribeBarriers(const GcodeFile& file, gcode::Policy policy,
                                          const gcode::Allowance& allow,
                                          const std::vector<bool>& counted = {});

// A line for each kind of moves that no path is made of and that therefore hold what they print:
// lines that cannot be read; relative moves (G91), and moves whose E word pushes nothing, where
// they are more than those that make paths.
std::vector<std::string> DescribeOddLines(const GcodeFile& file);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_GCODE_BARRIERS_H_
