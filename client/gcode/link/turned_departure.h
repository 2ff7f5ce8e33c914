// The short move with which a slicer leaves a loop, so that nothing of the retraction shows on it,
// for the same loop begun elsewhere.

#ifndef TRAVERSE_CLIENT_GCODE_LINK_TURNED_DEPARTURE_H_
#define TRAVERSE_CLIENT_GCODE_LINK_TURNED_DEPARTURE_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/model/point.h"

namespace traverse::gcode {

// Where that move leads, in mm, if the loop begins at `points[entry]`; in the file it begins at
// `points[0]`, and the move leads to `departs_to`. PrusaSlicer goes as far off as the nozzle is
// wide, or as the first segment is long, and turns from that segment to the inner side by a third
// of the loop's angle there. So it does here: to the same side of the loop, by the same share of
// the angle at the new start, as far off, but no farther than the first segment there is long.
// Nothing if the file's move does not lie between its loop's first and last segment. REQUIRES: at
// least three points, the last one at the first or just short of it; 0 < entry < points.size() - 1.
std::optional<Point> TurnedDeparture(const std::vector<Point>& points, uint32_t entry,
                                     Point departs_to);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_LINK_TURNED_DEPARTURE_H_
