// Points in the plane of a layer.

#ifndef TRAVERSE_CLIENT_GCODE_MACHINE_VERTEX_H_
#define TRAVERSE_CLIENT_GCODE_MACHINE_VERTEX_H_

#include <cmath>

namespace traverse::gcode {

// In mm.
struct Vertex {
  double x = 0;
  double y = 0;

  friend bool operator==(const Vertex&, const Vertex&) = default;
};

inline double Distance(Vertex a, Vertex b) {
  const double dx = a.x - b.x;
  const double dy = a.y - b.y;
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MACHINE_VERTEX_H_
