#include "client/gcode/visible_walls.h"

#include <algorithm>
#include <cstdint>

namespace traverse::gcode {
namespace {

// Ways begin and end at the middle of a line, which may be a wall itself or lie against one.
constexpr double kEndSlackMm = 0.25;

bool IsVisibleWall(Feature feature) {
  return feature == Feature::kOuterWall || feature == Feature::kLoop ||
         feature == Feature::kOverhangWall;
}

}  // namespace

VisibleWalls::VisibleWalls(const std::vector<Outline>& outlines)
    : grid_([&outlines] {
        std::vector<Segment> segments;
        for (size_t path = 0; path < outlines.size(); ++path) {
          const Outline& outline = outlines[path];
          if (!IsVisibleWall(outline.feature)) continue;
          const size_t n = outline.points.size();
          for (size_t k = 0; k + 1 < n; ++k) {
            segments.push_back(
                {outline.points[k], outline.points[k + 1], static_cast<uint32_t>(path)});
          }
          if (outline.closed && !outline.exactly_closed) {
            segments.push_back(
                {outline.points[n - 1], outline.points[0], static_cast<uint32_t>(path)});
          }
        }
        return segments;
      }()) {}

std::pair<Vertex, Vertex> VisibleWalls::Shortened(Vertex a, Vertex b) {
  const double length = Distance(a, b);
  const double cut = std::min(kEndSlackMm, length * 0.2) / std::max(length, 1e-9);
  return {{a.x + (b.x - a.x) * cut, a.y + (b.y - a.y) * cut},
          {b.x - (b.x - a.x) * cut, b.y - (b.y - a.y) * cut}};
}

bool VisibleWalls::Crossed(Vertex a, Vertex b) const {
  const auto [from, to] = Shortened(a, b);
  bool crossed = false;
  grid_.ForEachOnWay(from, to, [&, from = from, to = to](uint32_t s) {
    const Segment& wall = grid_.segments()[s];
    crossed = Cross(from, to, wall.a, wall.b);
    return !crossed;
  });
  return crossed;
}

}  // namespace traverse::gcode
