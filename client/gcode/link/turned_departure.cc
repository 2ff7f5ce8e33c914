#include "client/gcode/link/turned_departure.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace traverse::gcode {
namespace {

// Shorter than this, nothing tells to which side a move leads.
constexpr double kShortestMm = 0.01;

Point Between(Point from, Point to) { return {to.x - from.x, to.y - from.y}; }
double LengthOf(Point v) { return std::hypot(v.x, v.y); }

// From `u` to `v`, anticlockwise: 0 to 2 pi.
double AngleBetween(Point u, Point v) {
  const double angle = std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y);
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

// The start of a loop, with what leads away from it and, looking back, to it.
struct LoopStart {
  Point at;
  Point ahead;
  Point back;

  // The angle of the loop to its left.
  double Left() const { return AngleBetween(ahead, back); }
};

// The last point of the loop is its first one, or just short of that: a gap is no segment.
LoopStart StartAt(const std::vector<Point>& points, uint32_t entry) {
  const size_t n = points.size() - 1;
  const Point at = points[entry];
  const Point next = points[entry + 1 < n ? entry + 1 : 0];
  const Point before = points[entry > 0 ? entry - 1 : n - 1];
  return {at, Between(at, next), Between(at, before)};
}

}  // namespace

std::optional<Point> TurnedDeparture(const std::vector<Point>& points, uint32_t entry,
                                     Point departs_to) {
  assert(points.size() >= 3 && entry > 0 && entry < points.size() - 1);
  const LoopStart given = StartAt(points, 0);
  const LoopStart start = StartAt(points, entry);
  const Point move = Between(given.at, departs_to);
  const double first_mm = LengthOf(start.ahead);
  const double mm = std::min(LengthOf(move), first_mm);
  if (mm < kShortestMm || LengthOf(given.ahead) <= 0) return std::nullopt;
  const bool left = given.ahead.x * move.y - given.ahead.y * move.x > 0;
  const double full = 2 * std::numbers::pi;
  const double turned = AngleBetween(given.ahead, move);
  const double share = left ? turned / given.Left() : (full - turned) / (full - given.Left());
  if (!(share > 0 && share < 1)) return std::nullopt;
  const double angle = left ? share * start.Left() : -share * (full - start.Left());
  const Point u{start.ahead.x / first_mm, start.ahead.y / first_mm};
  const double c = std::cos(angle) * mm;
  const double s = std::sin(angle) * mm;
  return Point{start.at.x + u.x * c - u.y * s, start.at.y + u.x * s + u.y * c};
}

}  // namespace traverse::gcode
