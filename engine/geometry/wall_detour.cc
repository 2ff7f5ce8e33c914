#include "engine/geometry/wall_detour.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace traverse {
namespace {

// The steps that Rest counts for a bend beside a corner of a wall.
constexpr size_t kStepsOfBend = 8;

// Longer stretches of a wall are not followed.
constexpr size_t kMostVertices = 500;

// Moves that cross walls more often get no detour: it would take the square of that number.
constexpr size_t kMostHits = 250;

// Walls that block a detour around another wall.
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

WallDetours::WallDetours(const WallGrid& grid, double clearance_mm, double on_wall_mm,
                         Budget* budget)
    : grid_(grid), clearance_mm_(clearance_mm), on_wall_mm_(on_wall_mm) {
  Rest rest(budget);
  const std::vector<WallSegment>& segments = grid.segments();
  left_.reserve(segments.size());
  for (const WallSegment& segment : segments) {
    rest();
    left_.push_back(LeftOf(segment));
  }
  for (const double side : {-1.0, 1.0}) {
    Side& beside = sides_[side > 0 ? 1 : 0];
    beside.bends.reserve(segments.size());
    beside.upto_mm.reserve(segments.size());
    for (uint32_t s = 0; s < segments.size(); ++s) {
      rest(kStepsOfBend);
      const auto [first, end] = grid.SegmentsOf(segments[s].wall);
      beside.bends.push_back(Beside(s, s + 1 == end ? first : s + 1, segments[s].b, side));
      beside.upto_mm.push_back(
          s == first ? 0 : beside.upto_mm.back() + Distance(beside.bends[s - 1], beside.bends[s]));
    }
  }
}

std::vector<Point> WallDetours::Around(Point a, Point b, int64_t* tests) const {
  Hits hits = HitsOf(a, b, {});
  int64_t done = 1 + static_cast<int64_t>(hits.size());
  std::vector<Point> there = Along(a, b, hits, {}, 0, done);
  std::reverse(hits.begin(), hits.end());
  for (Hit& hit : hits) hit.along = 1 - hit.along;
  std::vector<Point> back = Along(b, a, hits, {}, 0, done);
  if (tests != nullptr) *tests += done;
  std::reverse(back.begin(), back.end());
  if (there.empty()) return back;
  if (back.empty() || LengthOf(a, there, b) <= LengthOf(a, back, b)) return there;
  return back;
}

bool WallDetours::IsClosed(uint32_t wall) const {
  const auto [first, end] = grid_.SegmentsOf(wall);
  return end - first > 2 && grid_.segments()[end - 1].b == grid_.segments()[first].a;
}

// In the order along the move, each segment once. Stops when there are more than kMostHits.
WallDetours::Hits WallDetours::HitsOf(Point a, Point b, MoveEnds ends) const {
  Hits hits;
  const auto put_in_order = [&hits] {
    std::sort(hits.begin(), hits.end(), [](const Hit& one, const Hit& other) {
      return std::pair(one.along, one.segment) < std::pair(other.along, other.segment);
    });
    const auto same = [](const Hit& one, const Hit& other) { return one.segment == other.segment; };
    hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
  };
  auto [from, to] = grid_.WithoutEnds(a, b, ends);
  // As WallGrid::Crosses looks at it, for a line along a wall crosses it from one end only.
  if (std::pair(to.x, to.y) < std::pair(from.x, from.y)) std::swap(from, to);
  grid_.ForEachOnLine(from, to, [&, from = from, to = to](uint32_t s) {
    const WallSegment& wall = grid_.segments()[s];
    if (!SegmentsCross(from, to, wall.a, wall.b)) return true;
    const Point left = left_[s];
    const double before = (wall.a.x - a.x) * left.x + (wall.a.y - a.y) * left.y;
    const double whole = (b.x - a.x) * left.x + (b.y - a.y) * left.y;
    hits.push_back({before / whole, s});
    // The grid visits a segment in each of its cells that the line passes.
    if (hits.size() <= 2 * kMostHits) return true;
    put_in_order();
    return hits.size() <= kMostHits;
  });
  put_in_order();
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

std::vector<Point> WallDetours::OneDetour(Point a, Point b, MoveEnds ends, int depth,
                                          int64_t& tests) const {
  const Hits hits = HitsOf(a, b, ends);
  tests += 1 + static_cast<int64_t>(hits.size());
  return Along(a, b, hits, ends, depth, tests);
}

// The detour along the walls of `hits`.
std::vector<Point> WallDetours::Along(Point a, Point b, const Hits& hits, MoveEnds ends, int depth,
                                      int64_t& tests) const {
  if (hits.empty() || hits.size() > kMostHits) return {};
  Bends detour = {{a, {}}};
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
    if (!Follow(first, behind, side, a, b, detour)) return {};
    i = last + 1;
  }
  detour.push_back({b, {}});
  return PulledTaut(detour, ends, depth, tests);
}

// Beside the corner between two segments, on the given side.
Point WallDetours::Beside(uint32_t before, uint32_t behind, Point at, double side) const {
  const Point one = left_[before];
  const Point other = left_[behind];
  Point middle{one.x + other.x, one.y + other.y};
  const double length = Distance({0, 0}, middle);
  const double out = side * clearance_mm_;
  if (!(length > 1e-3)) return {at.x + one.x * out, at.y + one.y * out};
  middle = {middle.x / length, middle.y / length};
  // At sharp corners no further out than twice the distance.
  const double reach = out / std::max(middle.x * one.x + middle.y * one.y, 0.5);
  return {at.x + middle.x * reach, at.y + middle.y * reach};
}

// The length beside a wall, and along it, from the bend of one segment to that of another.
double WallDetours::BetweenBends(uint32_t wall, const Side& side, uint32_t from,
                                 uint32_t to) const {
  const double between = side.upto_mm[to] - side.upto_mm[from];
  if (to >= from) return between;
  const auto [first, end] = grid_.SegmentsOf(wall);
  return side.upto_mm[end - 1] + Distance(side.bends[end - 1], side.bends[first]) + between;
}

// Appends the shorter way along a wall from one hit to another, on one side of it. False if it
// has too many corners.
bool WallDetours::Follow(const Hit& first, const Hit& last, double side, Point a, Point b,
                         Bends& detour) const {
  const uint32_t wall = WallOf(first.segment);
  const auto [from, to] = grid_.SegmentsOf(wall);
  const uint32_t n = to - from;
  const Side& beside = SideAt(side);
  const auto at = [from = from, n](uint32_t segment, uint32_t steps) {
    return from + (segment - from + steps) % n;
  };
  const Point begin = Beside(first.segment, first.segment, Between(a, b, first.along), side);
  const Point end = Beside(last.segment, last.segment, Between(a, b, last.along), side);
  // With the wall the corners at the ends of `first` up to the one before `last`; against it those
  // at the ends of the one before `first` down to `last`.
  const uint32_t corners[2] = {(first.segment + n - last.segment) % n,
                               (last.segment + n - first.segment) % n};
  const auto corner = [&](bool forward, uint32_t i) {
    return forward ? at(first.segment, i) : at(first.segment, n - 1 - i);
  };
  double lengths_mm[2];
  bool found[2];
  for (const bool forward : {false, true}) {
    const uint32_t count = corners[forward];
    found[forward] = count < kMostVertices;
    lengths_mm[forward] = Distance(begin, end);
    if (count == 0) continue;
    const uint32_t one = corner(forward, 0);
    const uint32_t other = corner(forward, count - 1);
    lengths_mm[forward] = Distance(begin, beside.bends[one]) +
                          (forward ? BetweenBends(wall, beside, one, other)
                                   : BetweenBends(wall, beside, other, one)) +
                          Distance(beside.bends[other], end);
  }
  if (!found[0] && !found[1]) return false;
  const bool forward = !found[0] || (found[1] && lengths_mm[1] <= lengths_mm[0]);
  const double corner_side = forward ? -side : side;
  detour.push_back({begin, Between(a, b, first.along), corner_side});
  for (uint32_t i = 0; i < corners[forward]; ++i) {
    const uint32_t s = corner(forward, i);
    detour.push_back({beside.bends[s], grid_.segments()[s].b, corner_side});
  }
  detour.push_back({end, Between(a, b, last.along), corner_side});
  return true;
}

// What is in sight from a bend past the corners of those behind it.
class WallDetours::Sight {
 public:
  explicit Sight(const Bend& from) : from_(from.at) { Pass(from); }

  // Passes `bend`. True if it is in sight past its corner and those before.
  bool Pass(const Bend& bend) {
    if (bend.side != 0) {
      Corner& corner = bend.side > 0 ? left_ : right_;
      if (!corner.passed || bend.side * Turn(corner.at, bend.corner) < 0) {
        corner = {bend.corner, true};
      }
    }
    return !(left_.passed && Turn(bend.at, left_.at) < 0) &&
           !(right_.passed && Turn(bend.at, right_.at) > 0);
  }

 private:
  // Of those on one side, the one that leaves least in sight.
  struct Corner {
    Point at;
    bool passed = false;
  };

  // Positive if `other` is to the left of `one`.
  double Turn(Point one, Point other) const {
    return (one.x - from_.x) * (other.y - from_.y) - (one.y - from_.y) * (other.x - from_.x);
  }

  const Point from_;
  Corner left_;
  Corner right_;
};

// The last bend up to which those behind bend `at` are in sight past the corners that they pass;
// the next one at least, and whatever other walls are in the way. That is no further than one wall
// is followed: the next one stands in its own way.
size_t WallDetours::LastInSight(const Bends& detour, size_t at) {
  Sight sight(detour[at]);
  size_t last = at + 1;
  sight.Pass(detour[last]);
  while (last + 1 < detour.size() && sight.Pass(detour[last + 1])) ++last;
  return last;
}

// `detour` without its ends and the bends that are not needed. Empty if a stretch crosses a wall
// around which there is no detour.
std::vector<Point> WallDetours::PulledTaut(const Bends& detour, MoveEnds ends, int depth,
                                           int64_t& tests) const {
  const auto ends_of = [&](size_t from, size_t to) {
    return MoveEnds{ends.a && from == 0, ends.b && to + 1 == detour.size()};
  };
  const auto crosses = [&](size_t from, size_t to) {
    ++tests;
    return grid_.Crosses(detour[from].at, detour[to].at, ends_of(from, to));
  };
  std::vector<Point> taut = {detour.front().at};
  for (size_t at = 0; at + 1 < detour.size();) {
    const size_t last = LastInSight(detour, at);
    size_t next = last;
    if (crosses(at, last)) {
      next = at + 1;
      if (last == next || crosses(at, next)) {
        if (depth == kMostDepth) return {};
        const std::vector<Point> around =
            OneDetour(detour[at].at, detour[next].at, ends_of(at, next), depth + 1, tests);
        if (around.empty()) return {};
        taut.insert(taut.end(), around.begin(), around.end());
      } else {
        while (next + 1 < detour.size() && !crosses(at, next + 1)) ++next;
      }
    }
    taut.push_back(detour[next].at);
    at = next;
  }
  Straighten(taut, ends, tests);
  return {taut.begin() + 1, taut.end() - 1};
}

// Leaves out bends that no wall requires: beyond a stretch that a wall blocks there may be a point
// that sees past the wall, and a detour around one wall may not fit the one into which it was
// inserted.
void WallDetours::Straighten(std::vector<Point>& detour, MoveEnds ends, int64_t& tests) const {
  if (detour.size() < 3) return;
  std::vector<Point> straight = {detour.front()};
  for (size_t at = 1; at < detour.size(); ++at) {
    for (; straight.size() > 1; straight.pop_back()) {
      // From end to end a wall is in the way: that is why there is a detour.
      if (straight.size() == 2 && at + 1 == detour.size()) break;
      ++tests;
      const MoveEnds of_line{ends.a && straight.size() == 2, ends.b && at + 1 == detour.size()};
      if (grid_.Crosses(straight[straight.size() - 2], detour[at], of_line)) break;
    }
    straight.push_back(detour[at]);
  }
  detour = std::move(straight);
}

}  // namespace traverse
