#include "client/gcode/plan/detour.h"

#include <cmath>

namespace traverse::gcode {
namespace {

// As slicers write coordinates: to micrometres.
double Written(double mm) { return std::round(mm * 1000) / 1000; }

}  // namespace

// The shortest travel passes a corner by next to nothing, and rounding may put it on the other
// side.
std::vector<Vertex> Detours::Around(Vertex a, Vertex b) const {
  std::vector<Vertex> bends;
  Vertex at = a;
  for (const Point& bend : detours_.Around({a.x, a.y}, {b.x, b.y})) {
    bends.push_back({Written(bend.x), Written(bend.y)});
    if (walls_.Crossed(at, bends.back())) return {};
    at = bends.back();
  }
  if (!bends.empty() && walls_.Crossed(at, b)) return {};
  return bends;
}

}  // namespace traverse::gcode
