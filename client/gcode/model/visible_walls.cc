#include "client/gcode/model/visible_walls.h"

namespace traverse::gcode {

bool IsVisibleWall(Feature feature) {
  return feature == Feature::kOuterWall || feature == Feature::kLoop ||
         feature == Feature::kOverhangWall;
}

std::vector<Wall> VisibleWallsOf(const std::vector<Outline>& outlines) {
  std::vector<Wall> walls;
  for (size_t path = 0; path < outlines.size(); ++path) {
    const Outline& outline = outlines[path];
    if (!IsVisibleWall(outline.feature) || outline.points.size() < 2) continue;
    Wall& wall = walls.emplace_back();
    wall.points.reserve(outline.shape().size());
    for (const Vertex& point : outline.shape()) wall.points.push_back({point.x, point.y});
    wall.closed = outline.is_loop;
    wall.path = static_cast<int>(path);
  }
  return walls;
}

}  // namespace traverse::gcode
