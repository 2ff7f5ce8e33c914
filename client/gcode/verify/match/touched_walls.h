// Travel that leads over a wall without crossing the middle of its line.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TOUCHED_WALLS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TOUCHED_WALLS_H_

#include <vector>

#include "client/gcode/verify/match/piece_tree.h"

namespace traverse::gcode {

// True if the moves, which follow each other, come right over one of the walls, and nearer to it
// than each end; or back to it, after they were away from that of an end. So travel along a wall
// does not touch it. Takes time for each point along the travel, and for the pieces near that.
bool TouchesWall(const PieceTree& walls, const std::vector<Piece>& moves);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_TOUCHED_WALLS_H_
