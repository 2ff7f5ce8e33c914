#include "client/gcode/plan/detour.h"

#include <cmath>

namespace traverse::gcode {
namespace {

// As slicers write coordinates: to micrometres.
double Written(double mm) { return std::round(mm * 1000) / 1000; }

}  // namespace

// The shortest detour passes corners by next to nothing, and rounding may put it on the other side.
std::vector<Point> Detours::Around(Point a, Point b) const {
  std::vector<Point> travel = {a};
  for (const Point& bend : detours_.Around(a, b)) {
    travel.push_back({Written(bend.x), Written(bend.y)});
  }
  if (travel.size() == 1) return {};
  travel.push_back(b);
  if (walls_.CrossedByTravel(travel)) return {};
  return {travel.begin() + 1, travel.end() - 1};
}

}  // namespace traverse::gcode
