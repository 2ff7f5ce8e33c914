// A short round trip through points.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ROUND_TRIP_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ROUND_TRIP_H_

#include <cstdint>
#include <vector>

#include "engine/model/point.h"

namespace traverse::gcode {

// The numbers of `points` in the order of a round trip that begins with the first one: the given
// order, improved by turning runs and by moving single points, until neither makes it shorter.
// O(n) a pass of points, each with the few hundred next to it in the trip; a limited number of
// passes.
std::vector<uint32_t> RoundTrip(const std::vector<Point>& points);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ROUND_TRIP_H_
