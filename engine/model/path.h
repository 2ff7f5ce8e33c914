// A path: what is deposited in one go.

#ifndef TRAVERSE_ENGINE_MODEL_PATH_H_
#define TRAVERSE_ENGINE_MODEL_PATH_H_

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

  // The island that the path belongs to: its position among the islands that the plan was built
  // from; -1 if the plan knows of none (engine/weller/steps/island_layout.h says what follows). Set
  // by the plan builders. It restricts no route; methods that reason about islands use it.
  int island = -1;

  // The contour that encloses its island. Set by the plan builders.
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
