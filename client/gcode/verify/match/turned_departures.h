// The short moves by which the original leaves its loops, for loops that begin elsewhere.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TURNED_DEPARTURES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TURNED_DEPARTURES_H_

#include <cstdint>

#include "absl/container/flat_hash_set.h"
#include "client/gcode/verify/match/layer_pair.h"

namespace traverse::gcode {

// The links of the other file that begin with the move by which the original leaves the loop before
// them, turned along with the loop's start: it divides the angle between the loop's first and last
// segment as it did, on the same side, and is as long as it was, or as the first segment there.
absl::flat_hash_set<uint32_t> TurnedDepartures(const LayerPair& layer);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TURNED_DEPARTURES_H_
