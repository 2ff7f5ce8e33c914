#include "engine/cost/travel_split.h"

#include <cstddef>

namespace traverse {

TravelSplit SplitTravel(const Plan& plan, const Route& route, Point start) {
  TravelSplit split;
  Point at = start;
  const Path* before = nullptr;
  for (const Visit& visit : route) {
    const Path& path = plan.paths[static_cast<size_t>(visit.path)];
    const double length_mm = Distance(at, EnterPoint(path, visit.entry));
    const bool from_open = before != nullptr && before->kind == Path::Kind::kOpen;
    if (path.kind == Path::Kind::kContour) {
      (from_open ? split.links_mm : split.contours_mm) += length_mm;
    } else {
      (from_open ? split.rasters_mm : split.links_mm) += length_mm;
    }
    at = ExitPoint(path, visit.entry);
    before = &path;
  }
  return split;
}

}  // namespace traverse
