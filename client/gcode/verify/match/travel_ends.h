// Identifies a travel move of the original in the other file by its two end points.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TRAVEL_ENDS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TRAVEL_ENDS_H_

#include <cassert>
#include <cmath>
#include <cstdint>

#include "client/gcode/verify/text.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

// A digest of two points, to the micrometre.
inline uint64_t DigestOfEnds(Point from, Point to) {
  const auto um = [](double mm) { return static_cast<uint64_t>(std::llround(mm * 1000)); };
  return Mix(Mix(um(from.x), um(from.y)), Mix(um(to.x), um(to.y)));
}

// A digest of the end of the path before and the start of the path after, to the micrometre.
// REQUIRES: link > 0.
inline uint64_t EndsOf(const TraceChunk& chunk, uint32_t link) {
  assert(link > 0);
  return DigestOfEnds(chunk.EndOf(chunk.paths[link - 1]), chunk.paths[link].start);
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TRAVEL_ENDS_H_
