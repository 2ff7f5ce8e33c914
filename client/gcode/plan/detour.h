// Ways around visible walls, for files whose slicer led its travel around them: those that the
// search counts with (engine/geometry/wall_detour.h).

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_DETOUR_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_DETOUR_H_

#include <vector>

#include "client/gcode/model/visible_walls.h"
#include "engine/geometry/wall_detour.h"

namespace traverse::gcode {

class Detours {
 public:
  // How far from the middle of a wall ways lead: about where the next line lies.
  static constexpr double kBesideMm = 0.4;

  // `walls` outlives the detours.
  explicit Detours(const VisibleWalls& walls) : detours_(walls.grid(), kBesideMm, kOnWallMm) {}

  // The points to go through from `a` to `b` so that no visible wall is crossed. Empty if the
  // straight way crosses none, and if no way around was found.
  std::vector<Vertex> Around(Vertex a, Vertex b) const;

 private:
  // A point this near to a wall's middle lies on it.
  static constexpr double kOnWallMm = 1.2 * VisibleWalls::kEndSlackMm;

  const WallDetours detours_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_DETOUR_H_
