// The ends of a plan's paths and the moves that may join them: every route is a tree of these.
//
// A path has one end (a contour, which is left where it is entered) or two (an open path). The
// moves within a node of the plan join its children to a tree. Each any_order node is a junction,
// and so is each pair of neighboring children of an in_order node; a route uses one move less in a
// junction than the junction has sides.
//
//   any_order(a, b, c)       one junction of three sides: two moves
//   in_order(A, B)           a junction of two sides: one move, from an end that may be the last
//                            of A to one that may be the first of B

#ifndef TRAVERSE_ENGINE_PROOF_TREES_END_GRAPH_H_
#define TRAVERSE_ENGINE_PROOF_TREES_END_GRAPH_H_

#include <cstdint>
#include <vector>

#include "absl/container/inlined_vector.h"
#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/geometry/bounding_box.h"
#include "engine/model/point.h"
#include "engine/model/tree/plan_tree.h"

namespace traverse {

struct PathEnd {
  static constexpr uint8_t kEnter = 1;
  static constexpr uint8_t kLeave = 2;

  absl::InlinedVector<Point, 1> points;  // where the head may be at this end
  BoundingBox box;                       // around them
  uint8_t roles = 0;                     // whether the path may be entered, or left, at this end
  int moves = 1;                         // of a route at this end: 2 for a contour
};

// The roles of which the other end of a move must have one.
inline int OppositeRoles(int roles) { return (roles >> 1 & 1) | (roles << 1 & 2); }

struct Junction {
  struct Member {
    int end = 0;
    int side = 0;
    uint8_t roles = 0;  // whether this side may be entered, or left, at this end
  };
  absl::InlinedVector<Member, 4> members;  // by sides
  int sides = 0;
};

// Lists of one point or of two paths are stored inline, because large layers have millions of them.
// Only Clear changes a graph. Memory: proportional to the points and to the sum over nodes of the
// ends below.
struct EndGraph {
  // Gives other threads their turn through `budget`, which may be null.
  explicit EndGraph(const PlanTree& tree, Budget* budget = nullptr);

  // Frees everything, which takes long for a large graph, and gives others their turn meanwhile.
  void Clear(Budget* budget);

  std::vector<PathEnd> ends;
  std::vector<Junction> junctions;
  std::vector<int> first;  // ends where a route may begin
  std::vector<int> last;   // ends where a route may end
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_TREES_END_GRAPH_H_
