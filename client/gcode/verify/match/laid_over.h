// Finds paths that are printed over what their layer has already: ironing, whatever it is called.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAID_OVER_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAID_OVER_H_

#include <vector>

#include "absl/types/span.h"
#include "client/gcode/verify/match/plane.h"
#include "client/gcode/work_limit.h"

namespace traverse::gcode {

// What is printed on a layer, in its order.
struct LaidPath {
  absl::Span<const Piece> pieces;
  double filament_per_mm = 0;
  bool solid = false;  // a wall or skin: its lines lie side by side
  bool asked = false;
};

// A line that fills a layer lies beside what was printed before it. Most of a line of ironing lies
// between two such lines that are no farther from each other than lines are there, or crosses
// them. How much it deposits says little: less than a usual line.
//
// True for each path with `asked` that is such a line. Looks at 16 points of each path, and at
// no more than some pieces for each that there is.
std::vector<bool> LaidOver(const std::vector<LaidPath>& paths, const WorkLimit& limit = {});

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAID_OVER_H_
