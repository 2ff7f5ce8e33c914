#include "client/gcode/detour.h"

#include <algorithm>
#include <cmath>

namespace traverse::gcode {
namespace {

// How far from the middle of a wall the way leads: about where the next line lies.
constexpr double kBesideMm = 0.4;

// Longer stretches of a wall are not followed.
constexpr size_t kMostVertices = 500;

// A point this near to a wall's middle lies on it.
constexpr double kOnWallMm = 0.3;

// Ways around walls that stand in the way around another one.
constexpr int kMostDepth = 2;

double SideOf(const Segment& s, Vertex p) {
  const double turn = (s.b.x - s.a.x) * (p.y - s.a.y) - (s.b.y - s.a.y) * (p.x - s.a.x);
  return turn > 0 ? 1 : -1;
}

// The unit vector to the left of a segment.
Vertex LeftOf(const Segment& s) {
  const double length = Distance(s.a, s.b);
  if (!(length > 0)) return {0, 0};
  return {-(s.b.y - s.a.y) / length, (s.b.x - s.a.x) / length};
}

Vertex Between(Vertex a, Vertex b, double share) {
  return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

double LengthOf(const std::vector<Vertex>& way) {
  double length = 0;
  for (size_t i = 1; i < way.size(); ++i) length += Distance(way[i - 1], way[i]);
  return length;
}

}  // namespace

Detours::Detours(const VisibleWalls& walls) : walls_(walls), segments_(walls.grid().segments()) {
  const auto n = static_cast<uint32_t>(segments_.size());
  wall_of_.resize(n);
  for (uint32_t begin = 0; begin < n;) {
    uint32_t end = begin + 1;
    while (end < n && segments_[end].path == segments_[begin].path) ++end;
    for (uint32_t s = begin; s < end; ++s) wall_of_[s] = static_cast<uint32_t>(wall_.size());
    wall_.push_back({begin, end, segments_[end - 1].b == segments_[begin].a});
    begin = end;
  }
}

std::vector<Detours::Hit> Detours::HitsOf(Vertex a, Vertex b) const {
  std::vector<Hit> hits;
  const auto [from, to] = VisibleWalls::Shortened(a, b);
  walls_.grid().ForEachOnWay(from, to, [&, from = from, to = to](uint32_t s) {
    const Segment& wall = segments_[s];
    if (Cross(from, to, wall.a, wall.b)) {
      const Vertex left = LeftOf(wall);
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

std::optional<uint32_t> Detours::SegmentAt(uint32_t wall, Vertex at) const {
  std::optional<uint32_t> nearest;
  double least = kOnWallMm * kOnWallMm;
  walls_.grid().ForEachOnWay(at, at, [&](uint32_t s) {
    const double distance = SquaredDistance(segments_[s], Segment{at, at, 0});
    if (wall_of_[s] == wall && distance < least) {
      least = distance;
      nearest = s;
    }
    return true;
  });
  return nearest;
}

std::vector<Vertex> Detours::Around(Vertex a, Vertex b) const { return Around(a, b, 0); }

std::vector<Vertex> Detours::Around(Vertex a, Vertex b, int depth) const {
  const std::vector<Hit> hits = HitsOf(a, b);
  if (hits.empty()) return {};
  std::vector<Vertex> way = {a};
  for (size_t i = 0; i < hits.size();) {
    const uint32_t wall = wall_of_[hits[i].segment];
    size_t last = i;
    size_t count = 0;
    for (size_t j = i; j < hits.size(); ++j) {
      if (wall_of_[hits[j].segment] != wall) continue;
      last = j;
      ++count;
    }
    if (!wall_[wall].closed) return {};
    Hit first = hits[i];
    Hit behind = hits[last];
    double side = SideOf(segments_[first.segment], a);
    if (count % 2 != 0) {
      // `a` is on its one side and `b` on the other, unless one of them lies on the wall itself.
      if (const std::optional<uint32_t> on = SegmentAt(wall, a)) {
        first = {0, *on};
        side = SideOf(segments_[behind.segment], b);
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
Vertex Detours::Beside(uint32_t before, uint32_t behind, Vertex at, double side) const {
  const Vertex one = LeftOf(segments_[before]);
  const Vertex other = LeftOf(segments_[behind]);
  Vertex middle{one.x + other.x, one.y + other.y};
  const double length = std::hypot(middle.x, middle.y);
  if (!(length > 1e-3)) return {at.x + one.x * side * kBesideMm, at.y + one.y * side * kBesideMm};
  middle = {middle.x / length, middle.y / length};
  // At sharp corners no further out than twice the distance.
  const double reach = kBesideMm / std::max(middle.x * one.x + middle.y * one.y, 0.5);
  return {at.x + middle.x * side * reach, at.y + middle.y * side * reach};
}

// Appends the way along a wall from one hit to another, on one side of it.
bool Detours::Follow(const Hit& first, const Hit& last, double side, Vertex a, Vertex b,
                     std::vector<Vertex>& way) const {
  const Wall& wall = wall_[wall_of_[first.segment]];
  const auto next = [&wall](uint32_t s) { return s + 1 == wall.end ? wall.begin : s + 1; };
  const auto previous = [&wall](uint32_t s) { return (s == wall.begin ? wall.end : s) - 1; };
  const Vertex begin = Beside(first.segment, first.segment, Between(a, b, first.along), side);
  const Vertex end = Beside(last.segment, last.segment, Between(a, b, last.along), side);
  std::vector<Vertex> forward = {begin};
  std::vector<Vertex> back = {begin};
  for (uint32_t s = first.segment; s != last.segment; s = next(s)) {
    forward.push_back(Beside(s, next(s), segments_[s].b, side));
  }
  for (uint32_t s = first.segment; s != last.segment; s = previous(s)) {
    back.push_back(Beside(previous(s), s, segments_[s].a, side));
  }
  forward.push_back(end);
  back.push_back(end);
  const std::vector<Vertex>& shorter = LengthOf(forward) <= LengthOf(back) ? forward : back;
  if (shorter.size() > kMostVertices) return false;
  way.insert(way.end(), shorter.begin(), shorter.end());
  return true;
}

// Leaves out the points that are not needed. False if a stretch crosses a wall, and there is no way
// around that one.
bool Detours::PullTaut(std::vector<Vertex>& way, int depth) const {
  std::vector<Vertex> taut = {way.front()};
  for (size_t at = 0; at + 1 < way.size();) {
    size_t next = at + 1;
    if (walls_.Crossed(way[at], way[next])) {
      if (depth == kMostDepth) return false;
      const std::vector<Vertex> around = Around(way[at], way[next], depth + 1);
      if (around.empty()) return false;
      taut.insert(taut.end(), around.begin(), around.end());
    } else {
      while (next + 1 < way.size() && !walls_.Crossed(way[at], way[next + 1])) ++next;
    }
    taut.push_back(way[next]);
    at = next;
  }
  way = std::move(taut);
  return true;
}

}  // namespace traverse::gcode
