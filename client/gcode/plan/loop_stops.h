// What it costs a closed path to begin where it begins: the machine stops there instead of passing.

#ifndef TRAVERSE_CLIENT_GCODE_PLAN_LOOP_STOPS_H_
#define TRAVERSE_CLIENT_GCODE_PLAN_LOOP_STOPS_H_

#include <cstdint>
#include <vector>

#include "client/gcode/model/outline.h"

namespace traverse::gcode {

// How the segments of a path are printed.
struct Pace {
  double speed_mm_s = 0;
  double accel_mm_s2 = 0;
  double corner_speed = 0;  // see machine/motion_planner.h
};

// From one point to another, of length 1; 0 if they are the same.
Vertex Direction(Vertex from, Vertex to);

class LoopStops {
 public:
  LoopStops() = default;

  // `points` are those of a closed path, of which the last is the first one or nearly so. Speed and
  // acceleration are above 0.
  LoopStops(const std::vector<Vertex>& points, const Pace& pace);

  // What the loop takes longer if the machine stops at `vertex` than if it passes there. A loop
  // that is too short to get going counts what it loses on both sides. REQUIRES: `points` and
  // `pace` are those of the loop; `vertex` is below their number but one.
  double Seconds(const std::vector<Vertex>& points, const Pace& pace, uint32_t vertex) const;

 private:
  std::vector<float> passing2_;  // [vertex] the square of the speed in (mm/s)^2
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_PLAN_LOOP_STOPS_H_
