// A route: what a strategy returns for a layer.

#ifndef TRAVERSE_ENGINE_MODEL_ROUTE_H_
#define TRAVERSE_ENGINE_MODEL_ROUTE_H_

#include <vector>

#include "engine/base/budget.h"
#include "engine/model/path.h"
#include "engine/model/plan.h"
#include "engine/model/point.h"

namespace traverse {

// One path of a route with its entry.
struct Visit {
  // Index into Plan::paths.
  int path = 0;

  // Contour: the vertex (index into Path::points) at which it begins and ends. Open path: 0 from
  // points[0] to points[1], 1 the other way.
  int entry = 0;

  friend bool operator==(const Visit&, const Visit&) = default;
};

// Every path of a plan once, in the order to do them.
using Route = std::vector<Visit>;

// Why a search ended.
enum class StopReason { kOptimal, kLocalOptimum, kIterationLimit, kTimeLimit, kCancelled };

// The points where `path` begins and where it ends if it is entered at `entry`.
inline Point EnterPoint(const Path& path, int entry) {
  return path.points[static_cast<size_t>(entry)];
}
inline Point ExitPoint(const Path& path, int entry) {
  return path.points[static_cast<size_t>(path.kind == Path::Kind::kContour ? entry : 1 - entry)];
}

// The entry in the given order: a contour's first allowed vertex, an open path's first end.
inline int GivenEntry(const Path& path) {
  return path.kind == Path::Kind::kContour && !path.allowed.empty() ? path.allowed[0] : 0;
}

// The given order: the tree's leaves from left to right, each at its given entry. If `before` pairs
// contradict the order of children, the leaves come in the first order (smallest child positions
// first) that keeps the pairs. Asks `budget` regularly, if it is not null.
Route GivenRoute(const Plan& plan, Budget* budget = nullptr);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_ROUTE_H_
