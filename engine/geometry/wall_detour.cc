#include "engine/geometry/wall_detour.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace traverse {
namespace {

// Longer stretches of a wall are not followed.
constexpr size_t kMostVertices = 500;

// Ways that cross walls more often are not led around them: it would take the square of that.
constexpr size_t kMostHits = 500;

// Ways around walls that stand in the way around another one.
constexpr int kMostDepth = 2;

double SideOf(const WallSegment& s, Point p) {
  const double turn = (s.b.x - s.a.x) * (p.y - s.a.y) - (s.b.y - s.a.y) * (p.x - s.a.x);
  return turn > 0 ? 1 : -1;
}

// The unit vector to the left of a segment.
Point LeftOf(const WallSegment& s) {
  const double length = Distance(s.a, s.b);
  return {-(s.b.y - s.a.y) / length, (s.b.x - s.a.x) / length};
}

Point Between(Point a, Point b, double share) {
  return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

double LengthOf(Point a, const std::vector<Point>& bends, Point b) {
  double length = 0;
  for (const Point& bend : bends) {
    length += Distance(a, bend);
    a = bend;
  }
  return length + Distance(a, b);
}

double DistanceTo(const WallSegment& s, Point p) {
  const double dx = s.b.x - s.a.x;
  const double dy = s.b.y - s.a.y;
  const double share = ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy);
  return Distance(p, Between(s.a, s.b, std::clamp(share, 0.0, 1.0)));
}

}  // namespace

std::vector<Point> WallDetours::Around(Point a, Point b) const {
  std::vector<Point> there = OneWay(a, b, 0);
  std::vector<Point> back = OneWay(b, a, 0);
  std::reverse(back.begin(), back.end());
  if (there.empty()) return back;
  if (back.empty() || LengthOf(a, there, b) <= LengthOf(a, back, b)) return there;
  return back;
}

bool WallDetours::IsClosed(uint32_t wall) const {
  const auto [first, end] = grid_.SegmentsOf(wall);
  return end - first > 2 && grid_.segments()[end - 1].b == grid_.segments()[first].a;
}

std::vector<WallDetours::Hit> WallDetours::HitsOf(Point a, Point b) const {
  std::vector<Hit> hits;
  const auto [from, to] = grid_.WithoutEnds(a, b);
  grid_.ForEachOnLine(from, to, [&, from = from, to = to](uint32_t s) {
    const WallSegment& wall = grid_.segments()[s];
    if (SegmentsCross(from, to, wall.a, wall.b)) {
      const Point left = LeftOf(wall);
      const double before = (wall.a.x - a.x) * left.x + (wall.a.y - a.y) * left.y;
      const double whole = (b.x - a.x) * left.x + (b.y - a.y) * left.y;
      hits.push_back({before / whole, s});
    }
    return true;
  });
  std::sort(hits.begin(), hits.end(), [](const Hit& one, const Hit& other) {
    return std::pair(one.along, one.segment) < std::pair(other.along, other.segment);
  });
  const auto same = [](const Hit& one, const Hit& other) { return one.segment == other.segment; };
  hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
  return hits;
}

// The segment of `wall` on which a point lies.
std::optional<uint32_t> WallDetours::SegmentAt(uint32_t wall, Point at) const {
  std::optional<uint32_t> nearest;
  double least = on_wall_mm_;
  for (const double dy : {-on_wall_mm_, 0.0, on_wall_mm_}) {
    const Point left{at.x - on_wall_mm_, at.y + dy};
    const Point right{at.x + on_wall_mm_, at.y + dy};
    grid_.ForEachOnLine(left, right, [&](uint32_t s) {
      if (WallOf(s) != wall) return true;
      const double distance = DistanceTo(grid_.segments()[s], at);
      if (distance < least || (distance == least && nearest && s < *nearest)) {
        least = distance;
        nearest = s;
      }
      return true;
    });
  }
  return nearest;
}

std::vector<Point> WallDetours::OneWay(Point a, Point b, int depth) const {
  const std::vector<Hit> hits = HitsOf(a, b);
  if (hits.empty() || hits.size() > kMostHits) return {};
  std::vector<Point> way = {a};
  for (size_t i = 0; i < hits.size();) {
    const uint32_t wall = WallOf(hits[i].segment);
    size_t last = i;
    size_t count = 0;
    for (size_t j = i; j < hits.size(); ++j) {
      if (WallOf(hits[j].segment) != wall) continue;
      last = j;
      ++count;
    }
    if (!IsClosed(wall)) return {};
    Hit first = hits[i];
    Hit behind = hits[last];
    double side = SideOf(grid_.segments()[first.segment], a);
    if (count % 2 != 0) {
      // `a` is on its one side and `b` on the other, unless one of them lies on the wall itself.
      if (const std::optional<uint32_t> on = SegmentAt(wall, a)) {
        first = {0, *on};
        side = SideOf(grid_.segments()[behind.segment], b);
      } else if (const std::optional<uint32_t> ends_on = SegmentAt(wall, b)) {
        behind = {1, *ends_on};
      } else {
        return {};
      }
    }
    if (!Follow(first, behind, side, a, b, way)) return {};
    i = last + 1;
  }
  way.push_back(b);
  if (!PullTaut(way, depth)) return {};
  return {way.begin() + 1, way.end() - 1};
}

// Beside the corner between two segments, on the side given.
Point WallDetours::Beside(uint32_t before, uint32_t behind, Point at, double side) const {
  const Point one = LeftOf(grid_.segments()[before]);
  const Point other = LeftOf(grid_.segments()[behind]);
  Point middle{one.x + other.x, one.y + other.y};
  const double length = Distance({0, 0}, middle);
  const double out = side * clearance_mm_;
  if (!(length > 1e-3)) return {at.x + one.x * out, at.y + one.y * out};
  middle = {middle.x / length, middle.y / length};
  // At sharp corners no further out than twice the distance.
  const double reach = out / std::max(middle.x * one.x + middle.y * one.y, 0.5);
  return {at.x + middle.x * reach, at.y + middle.y * reach};
}

// Appends the corners from one hit to another in one direction. False if they are too many.
bool WallDetours::FollowOneWay(const Hit& first, const Hit& last, bool forward, double side,
                               std::vector<Point>& way, double& length_mm) const {
  const auto [begin, end] = grid_.SegmentsOf(WallOf(first.segment));
  for (uint32_t s = first.segment; s != last.segment;) {
    const uint32_t next = forward ? (s + 1 == end ? begin : s + 1) : (s == begin ? end : s) - 1;
    const Point corner = forward ? grid_.segments()[s].b : grid_.segments()[s].a;
    const Point bend = forward ? Beside(s, next, corner, side) : Beside(next, s, corner, side);
    length_mm += Distance(way.back(), bend);
    way.push_back(bend);
    if (way.size() > kMostVertices) return false;
    s = next;
  }
  return true;
}

// Appends the shorter way along a wall from one hit to another, on one side of it.
bool WallDetours::Follow(const Hit& first, const Hit& last, double side, Point a, Point b,
                         std::vector<Point>& way) const {
  const Point begin = Beside(first.segment, first.segment, Between(a, b, first.along), side);
  const Point end = Beside(last.segment, last.segment, Between(a, b, last.along), side);
  std::vector<Point> ways[2];
  double lengths_mm[2] = {0, 0};
  bool found[2];
  for (const size_t forward : {size_t{0}, size_t{1}}) {
    ways[forward] = {begin};
    found[forward] =
        FollowOneWay(first, last, forward == 1, side, ways[forward], lengths_mm[forward]);
    lengths_mm[forward] += Distance(ways[forward].back(), end);
  }
  if (!found[0] && !found[1]) return false;
  const bool forward = !found[0] || (found[1] && lengths_mm[1] <= lengths_mm[0]);
  const std::vector<Point>& shorter = ways[forward ? 1 : 0];
  way.insert(way.end(), shorter.begin(), shorter.end());
  way.push_back(end);
  return true;
}

// Leaves out the points that are not needed. False if a stretch crosses a wall, and there is no way
// around that one.
bool WallDetours::PullTaut(std::vector<Point>& way, int depth) const {
  std::vector<Point> taut = {way.front()};
  for (size_t at = 0; at + 1 < way.size();) {
    size_t next = at + 1;
    if (grid_.Crosses(way[at], way[next])) {
      if (depth == kMostDepth) return false;
      const std::vector<Point> around = OneWay(way[at], way[next], depth + 1);
      if (around.empty()) return false;
      taut.insert(taut.end(), around.begin(), around.end());
    } else {
      while (next + 1 < way.size() && !grid_.Crosses(way[at], way[next + 1])) ++next;
    }
    taut.push_back(way[next]);
    at = next;
  }
  way = std::move(taut);
  return true;
}

}  // namespace traverse
