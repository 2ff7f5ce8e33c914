#include "client/gcode/model/visible_walls.h"

#include <algorithm>
#include <cmath>

#include "client/gcode/model/segment_grid.h"
#include "client/gcode/model/wall_crowd.h"
#include "engine/geometry/bounding_box.h"

namespace traverse::gcode {

namespace {

bool IsOne(const Outline& outline) {
  return IsVisibleWall(outline.feature) && outline.points.size() >= 2;
}

WallCrowd NoCrowdYet(const std::vector<Outline>& outlines) {
  BoundingBox box;
  for (const Outline& outline : outlines) {
    if (IsOne(outline)) box.Add(BoundingBox(outline.shape()));
  }
  return box.empty() ? WallCrowd({0, 0}, {0, 0}) : WallCrowd(box.low(), box.high());
}

// What is left of the moves without the ends of their whole travel.
std::vector<TravelLine> WithoutEnds(const std::vector<TravelLine>& moves) {
  double length = 0;
  for (const TravelLine& move : moves) length += Distance(move.from, move.to);
  const double slack = std::min(VisibleWalls::kEndSlackMm, 0.2 * length);
  std::vector<TravelLine> left;
  double at = 0;
  for (const auto& [begin, end] : moves) {
    const double own = Distance(begin, end);
    const double from = std::clamp(slack - at, 0.0, own);
    const double to = std::clamp(length - slack - at, 0.0, own);
    at += own;
    if (to <= from) continue;
    const auto point = [&, a = begin, b = end](double mm) -> Point {
      return {a.x + (b.x - a.x) * mm / own, a.y + (b.y - a.y) * mm / own};
    };
    left.push_back({point(from), point(to)});
  }
  return left;
}

std::vector<TravelLine> MovesOf(absl::Span<const Point> travel) {
  std::vector<TravelLine> moves;
  for (size_t i = 1; i < travel.size(); ++i) moves.push_back({travel[i - 1], travel[i]});
  return moves;
}

}  // namespace

bool IsVisibleWall(Feature feature) { return IsWall(feature) && feature != Feature::kInnerWall; }

std::vector<Wall> VisibleWallsOf(const std::vector<Outline>& outlines) {
  std::vector<Wall> walls;
  WallCrowd crowd = NoCrowdYet(outlines);
  for (size_t path = 0; path < outlines.size(); ++path) {
    const Outline& outline = outlines[path];
    if (!IsOne(outline) || !crowd.Takes(outline.shape())) continue;
    Wall& wall = walls.emplace_back();
    wall.points = outline.shape();
    wall.closed = outline.is_loop;
    wall.path = static_cast<int>(path);
  }
  return walls;
}

VisibleWalls::VisibleWalls(const std::vector<Outline>& outlines)
    : VisibleWalls(outlines, VisibleWallsOf(outlines)) {}

VisibleWalls::VisibleWalls(const std::vector<Outline>& outlines, const std::vector<Wall>& walls)
    : grid_(walls, kEndSlackMm) {
  half_mm_.reserve(walls.size());
  for (const Wall& wall : walls) {
    half_mm_.push_back(outlines[static_cast<size_t>(wall.path)].width_mm / 2);
    widest_half_mm_ = std::max(widest_half_mm_, half_mm_.back());
  }
}

bool VisibleWalls::Touched(absl::Span<const Point> travel) const {
  // Arcs are chords here, and coordinates are rounded.
  constexpr double kNearerMm = 0.02;
  const std::vector<TravelLine> moves = WithoutEnds(MovesOf(travel));
  if (moves.empty()) return false;
  std::vector<Point> line = {moves[0].from};
  for (const TravelLine& move : moves) line.push_back(move.to);
  const size_t last = line.size() - 1;
  const std::vector<Point> back(line.rbegin(), line.rend());
  bool touches = false;
  for (size_t i = 1; i <= last && !touches; ++i) {
    const auto visit = [&](uint32_t s) {
      const WallSegment& wall = grid_.segments()[s];
      const double half = half_mm_[wall.wall];
      const double mm =
          std::sqrt(SquaredDistance(Segment{line[i - 1], line[i]}, Segment{wall.a, wall.b}));
      if (mm >= half) return true;
      const auto nearer_than_first = [&](const std::vector<Point>& from, size_t leg) {
        return mm + kNearerMm < DistanceMm(wall.wall, from[0], half) ||
               (mm + kNearerMm < half && ComesBack(from, leg, wall, half));
      };
      touches = nearer_than_first(line, i) && nearer_than_first(back, last + 1 - i);
      return !touches;
    };
    grid_.ForEachOnLine(line[i - 1], line[i], visit, widest_half_mm_);
  }
  return touches;
}

bool VisibleWalls::ComesBack(const std::vector<Point>& line, size_t leg, const WallSegment& to,
                             double half_mm) const {
  constexpr double kStepMm = 0.25;
  constexpr double kMostSteps = 10'000;  // farther than any printer moves
  // Less than bends keep off the middle of lines up to 0.7 mm wide.
  const double away_mm = half_mm + 0.05;
  const Segment piece{to.a, to.b};
  for (size_t i = 1; i <= leg; ++i) {
    const Point from = line[i - 1];
    const double dx = line[i].x - from.x;
    const double dy = line[i].y - from.y;
    const double steps = std::min(std::ceil(std::hypot(dx, dy) / kStepMm), kMostSteps);
    for (double step = 0; step <= steps; ++step) {
      const double share = steps > 0 ? step / steps : 0;
      const Point at{from.x + dx * share, from.y + dy * share};
      if (i == leg && SquaredDistance(Segment{at, at}, piece) < away_mm * away_mm) return false;
      if (DistanceMm(to.wall, at, away_mm) >= away_mm) return true;
    }
  }
  return false;
}

double VisibleWalls::DistanceMm(uint32_t wall, Point point, double most_mm) const {
  const Segment at{point, point};
  double squared = most_mm * most_mm;
  const auto visit = [&](uint32_t s) {
    const WallSegment& near = grid_.segments()[s];
    if (near.wall == wall) {
      squared = std::min(squared, SquaredDistance(at, Segment{near.a, near.b}));
    }
    return true;
  };
  grid_.ForEachOnLine(point, point, visit, most_mm);
  return std::sqrt(squared);
}

bool VisibleWalls::IsOnOne(Point point) const {
  constexpr double kBesideMm = 0.05;
  const Segment at{point, point};
  bool found = false;
  const auto visit = [&](uint32_t s) {
    const WallSegment& wall = grid_.segments()[s];
    found = SquaredDistance(at, Segment{wall.a, wall.b}) <= kBesideMm * kBesideMm;
    return !found;
  };
  grid_.ForEachOnLine(point, point, visit, kBesideMm);
  return found;
}

bool VisibleWalls::CrossedByTravel(const std::vector<Point>& travel) const {
  return CrossedByMoves(MovesOf(travel));
}

bool VisibleWalls::CrossedByMoves(const std::vector<TravelLine>& moves) const {
  if (moves.size() == 1) return Crossed(moves[0].from, moves[0].to);
  bool crosses = false;
  for (const auto& [a, b] : WithoutEnds(moves)) {
    if (crosses) break;
    grid_.ForEachOnLine(a, b, [&, a = a, b = b](uint32_t s) {
      crosses = SegmentsCross(a, b, grid_.segments()[s].a, grid_.segments()[s].b);
      return !crosses;
    });
  }
  return crosses;
}

}  // namespace traverse::gcode
