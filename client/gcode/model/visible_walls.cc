#include "client/gcode/model/visible_walls.h"

#include <algorithm>
#include <limits>

#include "client/gcode/model/segment_grid.h"
#include "client/gcode/model/wall_crowd.h"

namespace traverse::gcode {

namespace {

bool IsOne(const Outline& outline) {
  return IsVisibleWall(outline.feature) && outline.points.size() >= 2;
}

WallCrowd NoCrowdYet(const std::vector<Outline>& outlines) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vertex low{kFar, kFar};
  Vertex high{-kFar, -kFar};
  for (const Outline& outline : outlines) {
    if (!IsOne(outline)) continue;
    for (const Vertex& point : outline.shape()) {
      low = {std::min(low.x, point.x), std::min(low.y, point.y)};
      high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
  }
  return low.x <= high.x ? WallCrowd(low, high) : WallCrowd({0, 0}, {0, 0});
}

}  // namespace

bool IsVisibleWall(Feature feature) {
  return feature == Feature::kOuterWall || feature == Feature::kLoop ||
         feature == Feature::kOverhangWall;
}

std::vector<Wall> VisibleWallsOf(const std::vector<Outline>& outlines) {
  std::vector<Wall> walls;
  WallCrowd crowd = NoCrowdYet(outlines);
  for (size_t path = 0; path < outlines.size(); ++path) {
    const Outline& outline = outlines[path];
    if (!IsOne(outline) || !crowd.Takes(outline.shape())) continue;
    Wall& wall = walls.emplace_back();
    wall.points.reserve(outline.shape().size());
    for (const Vertex& point : outline.shape()) wall.points.push_back({point.x, point.y});
    wall.closed = outline.is_loop;
    wall.path = static_cast<int>(path);
  }
  return walls;
}

bool VisibleWalls::IsOnOne(Vertex point) const {
  constexpr double kBesideMm = 0.05;
  const Segment at{point, point, 0};
  bool found = false;
  const auto visit = [&](uint32_t s) {
    const WallSegment& wall = grid_.segments()[s];
    const Segment segment{{wall.a.x, wall.a.y}, {wall.b.x, wall.b.y}, 0};
    found = found || SquaredDistance(at, segment) <= kBesideMm * kBesideMm;
    return !found;
  };
  for (const double side : {-kBesideMm, kBesideMm}) {
    grid_.ForEachOnLine({point.x - kBesideMm, point.y + side},
                        {point.x + kBesideMm, point.y + side}, visit);
  }
  return found;
}

bool VisibleWalls::CrossedByTravel(const std::vector<Vertex>& travel) const {
  std::vector<TravelLine> moves;
  for (size_t i = 1; i < travel.size(); ++i) moves.push_back({travel[i - 1], travel[i]});
  return CrossedByMoves(moves);
}

bool VisibleWalls::CrossedByMoves(const std::vector<TravelLine>& moves) const {
  if (moves.size() == 1) return Crossed(moves[0].from, moves[0].to);
  double length = 0;
  for (const TravelLine& move : moves) length += Distance(move.from, move.to);
  const double slack = std::min(kEndSlackMm, 0.2 * length);
  bool crosses = false;
  double at = 0;
  for (size_t i = 0; i < moves.size() && !crosses; ++i) {
    const auto& [begin, end] = moves[i];
    const double own = Distance(begin, end);
    const double from = std::clamp(slack - at, 0.0, own);
    const double to = std::clamp(length - slack - at, 0.0, own);
    at += own;
    if (to <= from) continue;
    const auto point = [&, a = begin, b = end](double mm) -> Point {
      return {a.x + (b.x - a.x) * mm / own, a.y + (b.y - a.y) * mm / own};
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
