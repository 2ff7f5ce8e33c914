#include "client/gcode/model/visible_walls.h"

#include <algorithm>

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

bool VisibleWalls::CrossedByWay(const std::vector<Vertex>& way) const {
  double length = 0;
  for (size_t i = 1; i < way.size(); ++i) length += Distance(way[i - 1], way[i]);
  const double slack = std::min(kEndSlackMm, 0.2 * length);
  bool crosses = false;
  double at = 0;
  for (size_t i = 1; i < way.size() && !crosses; ++i) {
    const double own = Distance(way[i - 1], way[i]);
    const double from = std::clamp(slack - at, 0.0, own);
    const double to = std::clamp(length - slack - at, 0.0, own);
    at += own;
    if (to <= from) continue;
    const auto point = [&](double mm) -> Point {
      return {way[i - 1].x + (way[i].x - way[i - 1].x) * mm / own,
              way[i - 1].y + (way[i].y - way[i - 1].y) * mm / own};
    };
    const Point a = point(from);
    const Point b = point(to);
    grid_.ForEachOnLine(a, b, [&](uint32_t s) {
      crosses = SegmentsCross(a, b, grid_.segments()[s].a, grid_.segments()[s].b);
      return !crosses;
    });
  }
  return crosses;
}

}  // namespace traverse::gcode
