// Detours around walls.
//
//        a        b                 a        b
//   -----+--------+-----       -----+        +-----
//   |    |        |    |       |    |        |    |     The detour follows the wall at a distance,
//   |  __|________|__  |       |  __|_      _|__  |     from where the straight move first meets it
//   | |  |        |  | |       | |  | |    | |  | |     to where it last leaves it, the shorter
//   side | |  +--------+  | |       | |  | +----+ |  | |     round, and is then pulled taut.

#ifndef TRAVERSE_ENGINE_GEOMETRY_WALL_DETOUR_H_
#define TRAVERSE_ENGINE_GEOMETRY_WALL_DETOUR_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "engine/geometry/wall_grid.h"
#include "engine/model/point.h"

namespace traverse {

class WallDetours {
 public:
  // `grid` must outlive this object. Detours pass walls at `clearance_mm`. A point nearer
  // to a wall than `on_wall_mm` lies on it. Asks `budget` regularly, if it is not null.
  // O(w).
  WallDetours(const WallGrid& grid, double clearance_mm, double on_wall_mm,
              Budget* budget = nullptr);

  // The bends of a detour from `a` to `b` whose straight pieces cross no wall (WallGrid::Crosses,
  // with nothing ignored at the bends).
  // Empty if the straight move crosses none, and if no detour was found: there is none from one
  // island to another, and this does not search mazes. Returns the shorter of the detours found in
  // the two directions. Does O(w) tests for crossings, for w points of the walls followed, and adds
  // their number to `tests` unless that is null.
  std::vector<Point> Around(Point a, Point b, int64_t* tests = nullptr) const;

 private:
  // Where a move crosses a wall: the segment, and the position along the move.
  struct Hit {
    double along = 0;
    uint32_t segment = 0;
  };

  // A point of a detour, and the corner of a wall that it passes.
  struct Bend {
    Point at;
    Point corner;
    double side = 0;  // of the detour, on which the corner is: 1 left, -1 right; 0: there is none
  };

  class Sight;

  // Most are few, and take no memory elsewhere.
  using Hits = absl::InlinedVector<Hit, 16>;
  using Bends = absl::InlinedVector<Bend, 32>;

  uint32_t WallOf(uint32_t segment) const { return grid_.segments()[segment].wall; }
  bool IsClosed(uint32_t wall) const;
  Hits HitsOf(Point a, Point b, MoveEnds ends) const;
  std::vector<Point> OneDetour(Point a, Point b, MoveEnds ends, int depth, int64_t& tests) const;
  std::vector<Point> Along(Point a, Point b, const Hits& hits, MoveEnds ends, int depth,
                           int64_t& tests) const;
  std::optional<uint32_t> SegmentAt(uint32_t wall, Point at) const;
  bool Follow(const Hit& first, const Hit& last, double side, Point a, Point b,
              Bends& detour) const;
  Point Beside(uint32_t before, uint32_t behind, Point at, double side) const;

  // One side of the walls.
  struct Side {
    std::vector<Point> bends;     // [segment] beside the corner at its end
    std::vector<double> upto_mm;  // [segment] length from the first bend of its wall to its own
  };
  const Side& SideAt(double side) const { return sides_[side > 0 ? 1 : 0]; }
  double BetweenBends(uint32_t wall, const Side& side, uint32_t from, uint32_t to) const;
  static size_t LastInSight(const Bends& detour, size_t at);
  std::vector<Point> PulledTaut(const Bends& detour, MoveEnds ends, int depth,
                                int64_t& tests) const;
  void Straighten(std::vector<Point>& detour, MoveEnds ends, int64_t& tests) const;

  const WallGrid& grid_;
  const double clearance_mm_;
  const double on_wall_mm_;
  std::vector<Point> left_;  // [segment] the unit vector to its left
  Side sides_[2];            // on the right, on the left
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_GEOMETRY_WALL_DETOUR_H_
