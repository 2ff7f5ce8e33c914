// Ways around visible walls, for files whose slicer led its travel around them.
//
//        a        b                 a        b
//   -----+--------+-----       -----+        +-----
//   |    |        |    |       |    |        |    |     The wall is followed at a distance from
//   |  __|________|__  |       |  __|_      _|__  |     where the straight way meets it first to
//   | |  |        |  | |       | |  | |    | |  | |     where it leaves it last, the shorter way
//   | |  +--------+  | |       | |  | +----+ |  | |     round, and the way is pulled taut.

#ifndef TRAVERSE_CLIENT_GCODE_DETOUR_H_
#define TRAVERSE_CLIENT_GCODE_DETOUR_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "client/gcode/visible_walls.h"

namespace traverse::gcode {

class Detours {
 public:
  // `walls` outlives the detours.
  explicit Detours(const VisibleWalls& walls);

  // The points to go through from `a` to `b` so that no visible wall is crossed. Empty if the
  // straight way crosses none, and if no way around was found: from one island to another there is
  // none, and through a maze this does not look for one. O(w) tests for walls crossed, w vertices
  // of the walls followed.
  std::vector<Vertex> Around(Vertex a, Vertex b) const;

 private:
  // Where a way crosses a wall: a segment, and how far along the way.
  struct Hit {
    double along = 0;
    uint32_t segment = 0;
  };

  // The segments of one wall: [begin, end) of the grid's.
  struct Wall {
    uint32_t begin = 0;
    uint32_t end = 0;
    bool closed = false;
  };

  std::vector<Hit> HitsOf(Vertex a, Vertex b) const;
  std::vector<Vertex> Around(Vertex a, Vertex b, int depth) const;
  std::optional<uint32_t> SegmentAt(uint32_t wall, Vertex at) const;
  bool Follow(const Hit& first, const Hit& last, double side, Vertex a, Vertex b,
              std::vector<Vertex>& way) const;
  Vertex Beside(uint32_t before, uint32_t behind, Vertex at, double side) const;
  bool PullTaut(std::vector<Vertex>& way, int depth) const;

  const VisibleWalls& walls_;
  const std::vector<Segment>& segments_;
  std::vector<uint32_t> wall_of_;  // [segment]
  std::vector<Wall> wall_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_DETOUR_H_
