// Detours around visible walls, for files whose slicer led its travel around them. The search
// counts with the same detours (engine/geometry/wall_detour.h). And for hidden travel, which other
// files may have too.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_DETOUR_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_DETOUR_H_

#include <vector>

#include "client/gcode/model/visible_walls.h"
#include "engine/geometry/wall_detour.h"

namespace traverse::gcode {

class Detours {
 public:
  // Distance of detours from the middle of a wall: about where the next line lies.
  static constexpr double kBesideMm = 0.4;

  // Detours pass walls at `beside_mm`. `walls` must outlive the detours.
  explicit Detours(const VisibleWalls& walls, double beside_mm = kBesideMm)
      : walls_(walls), detours_(walls.grid(), beside_mm, kOnWallMm) {}

  // The points to pass from `a` to `b` so that no visible wall is crossed, in whole micrometres.
  // Empty if the straight move crosses none, and if no detour was found.
  std::vector<Point> Around(Point a, Point b) const;

 private:
  // A point this close to the middle of a wall lies on it.
  static constexpr double kOnWallMm = 1.2 * VisibleWalls::kEndSlackMm;

  const VisibleWalls& walls_;
  const WallDetours detours_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_DETOUR_H_
