// Ways around walls.
//
//        a        b                 a        b
//   -----+--------+-----       -----+        +-----
//   |    |        |    |       |    |        |    |     The wall is followed at a distance from
//   |  __|________|__  |       |  __|_      _|__  |     where the straight way meets it first to
//   | |  |        |  | |       | |  | |    | |  | |     where it leaves it last, the shorter way
//   | |  +--------+  | |       | |  | +----+ |  | |     round, and the way is pulled taut.

#ifndef TRAVERSE_ENGINE_GEOMETRY_WALL_DETOUR_H_
#define TRAVERSE_ENGINE_GEOMETRY_WALL_DETOUR_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/geometry/wall_grid.h"
#include "engine/model/point.h"

namespace traverse {

class WallDetours {
 public:
  // `grid` outlives the detours. Ways lead by walls at `clearance_mm`; a point nearer to one than
  // `on_wall_mm` lies on it.
  // O(w); asks `budget`, if there is one, meanwhile.
  WallDetours(const WallGrid& grid, double clearance_mm, double on_wall_mm,
              Budget* budget = nullptr);

  // The bends of a way from `a` to `b` whose straight pieces cross no wall (WallGrid::Crosses).
  // Empty if the straight way crosses none, and if no way was found: from one island to another
  // there is none, and through a maze this does not look for one. The shorter one of what is found
  // there and back. O(w) tests for walls crossed, w points of the walls followed; their number is
  // added to `tests`, unless that is null.
  std::vector<Point> Around(Point a, Point b, int64_t* tests = nullptr) const;

 private:
  // Where a way crosses a wall: a segment, and how far along the way.
  struct Hit {
    double along = 0;
    uint32_t segment = 0;
  };

  uint32_t WallOf(uint32_t segment) const { return grid_.segments()[segment].wall; }
  bool IsClosed(uint32_t wall) const;
  std::vector<Hit> HitsOf(Point a, Point b) const;
  std::vector<Point> OneWay(Point a, Point b, int depth, int64_t& tests) const;
  std::optional<uint32_t> SegmentAt(uint32_t wall, Point at) const;
  bool Follow(const Hit& first, const Hit& last, double side, Point a, Point b,
              std::vector<Point>& way) const;
  Point Beside(uint32_t before, uint32_t behind, Point at, double side) const;

  // On one side of the walls.
  struct Side {
    std::vector<Point> bends;     // [segment] beside the corner at its end
    std::vector<double> upto_mm;  // [segment] from the first bend of its wall to its own
  };
  const Side& SideAt(double side) const { return sides_[side > 0 ? 1 : 0]; }
  double BetweenBends(uint32_t wall, const Side& side, uint32_t from, uint32_t to) const;
  bool PullTaut(std::vector<Point>& way, int depth, int64_t& tests) const;
  void Straighten(std::vector<Point>& way, int64_t& tests) const;

  const WallGrid& grid_;
  const double clearance_mm_;
  const double on_wall_mm_;
  std::vector<Point> left_;  // [segment] the unit vector to its left
  Side sides_[2];            // on the right, on the left
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_WALL_DETOUR_H_
