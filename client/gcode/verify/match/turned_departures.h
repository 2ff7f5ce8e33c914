// The short moves by which the original leaves its loops, for loops that begin elsewhere.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TURNED_DEPARTURES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TURNED_DEPARTURES_H_

#include <cstdint>

#include "absl/container/flat_hash_map.h"
#include "client/gcode/verify/match/layer_pair.h"

namespace traverse::gcode {

// Those of the layer's loops.
class TurnedDepartures {
 public:
  explicit TurnedDepartures(const LayerPair& layer);

  // Whether `link` of the other file begins with the move by which the original leaves the loop
  // before it, turned along with the loop's start: it divides the angle between the loop's first
  // and last segment as it did, on the same side, and is as long as it was, or as the first segment
  // there.
  bool LeadsAway(uint32_t link) const;

 private:
  const TraceChunk& is_;
  absl::flat_hash_map<uint32_t, Point> ends_;  // by link of the other file
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TURNED_DEPARTURES_H_
