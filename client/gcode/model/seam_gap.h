// The gap that slicers leave between the end of a loop and its start, so that no blob forms there.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_SEAM_GAP_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_SEAM_GAP_H_

#include <cstdint>
#include <vector>

#include "client/gcode/model/path_body.h"

namespace traverse::gcode {

// Moves the gap of a loop along to another start: the last segment closes it, or one that is
// appended where that would bend or there are but two; and the segment before the new start,
// `segments[entry - 1]`, ends as much earlier, with as much less filament. Firmware slows down at
// short segments beside a corner (by 8 ms at each on Klipper), so that one of its own is the second
// choice. False, and nothing changes, if there is hardly a gap, or if one of the segments beside
// the two places is an arc, or is too short, or if they differ in filament per mm. `segments` are
// those of a closed path in the file's order and in mm. REQUIRES: 0 < entry < segments.size().
bool MoveGap(uint32_t entry, std::vector<BodySegment>& segments);

// Whether MoveGap would move it.
bool MovesGap(uint32_t entry, const std::vector<BodySegment>& segments);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_SEAM_GAP_H_
