// Loops that take their gap along.
//
// Slicers end loops a little short of their start. A loop that begins elsewhere may close that gap
// and leave the same one before its new start:
//
//   original    0 1 2 3 .      . the gap, | a shorter segment
//   the other   2 3 G 0 |      G what closes the gap, a segment of its own or the rest of 3
//               G 0 1 |      the same begun with 3, whose rest G is
//
// The same filament is printed on the same length: as much per mm as the segment before the gap
// has, and as much as the shorter segment has less.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_MOVED_GAPS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_MOVED_GAPS_H_

#include <cstdint>
#include <vector>

#include "client/gcode/verify/findings.h"
#include "client/gcode/verify/trace/trace.h"
#include "client/gcode/work_limit.h"

namespace traverse::gcode {

struct MovedGap {
  uint32_t section = 0;           // from the beginning of the file
  std::vector<uint64_t> printed;  // digests: what closes the gap, the shorter segment
  std::vector<uint64_t> as;       // those of the original's segments
};

// Finds these loops and takes their gaps back: in `optimised` nothing closes the gap afterwards,
// and the segments that are longer and shorter have the digests of the original's. Adds a finding
// for each that does not print the same filament on the same length: that is not the same print.
// Uses `threads` threads.
std::vector<MovedGap> TakeBackMovedGaps(const TraceChunk& original, TraceChunk& optimised,
                                        int threads, std::vector<Finding>& findings,
                                        const WorkLimit& limit = {});

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_MOVED_GAPS_H_
