#include "client/gcode/plan/detour.h"

namespace traverse::gcode {

std::vector<Vertex> Detours::Around(Vertex a, Vertex b) const {
  std::vector<Vertex> bends;
  for (const Point& bend : detours_.Around({a.x, a.y}, {b.x, b.y})) {
    bends.push_back({bend.x, bend.y});
  }
  return bends;
}

}  // namespace traverse::gcode
