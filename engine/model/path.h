// A path: what is deposited without interruption.

#ifndef TRAVERSE_ENGINE_MODEL_PATH_H_
#define TRAVERSE_ENGINE_MODEL_PATH_H_

#include <utility>
#include <vector>

#include "engine/model/point.h"

namespace traverse {

// A contour (closed: entered and left at one vertex) or an open path (entered at one end, left at
// the other). SPEC section 1.
struct Path {
  enum class Kind { kContour, kOpen };

  Kind kind = Kind::kContour;

  // Contour: its vertices, at least one. Open path: its two ends, first and last.
  std::vector<Point> points;

  // Contour: the vertices at which it may be entered, distinct; empty for all of them.
  std::vector<int> allowed;

  // Open path: always from points[0] to points[1].
  bool one_way = false;

  // The island of the path: its position among the islands from which the plan was built; -1 if the
  // plan has none (engine/weller/steps/island_layout.h says what follows). The plan builders set
  // it. It restricts no route; methods that reason about islands use it.
  int island = -1;

  // True for the contour that encloses its island. The plan builders set it.
  bool outer = false;
};

inline Path MakeContour(std::vector<Point> vertices, std::vector<int> allowed = {}) {
  return Path{Path::Kind::kContour, std::move(vertices), std::move(allowed)};
}

inline Path MakeOpenPath(Point first, Point last, bool one_way = false) {
  return Path{Path::Kind::kOpen, {first, last}, {}, one_way};
}

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_PATH_H_
