#include "engine/souza/point_release.h"

#include <cassert>
#include <cstddef>
#include <limits>
#include <optional>

#include "engine/base/tolerances.h"
#include "engine/cost/two_moves.h"

namespace traverse {
namespace {

// The moves to and from `entry`, if they cost at most `most`; otherwise something above.
double MovesAround(const LayerView& layer, Point from, int entry, const std::optional<Point>& to,
                   double most = std::numeric_limits<double>::infinity()) {
  const TwoMoves moves{from, layer.table.enter(entry), layer.table.exit(entry), to};
  return moves.CostWithin(most, layer.cost);
}

// Returns the change of cost.
double ReleasePoint(SearchRoute& route, int position) {
  const LayerView& layer = route.layer();
  const int present = route.entry(position);
  const int path = layer.table.path_of(present);
  const Point from = route.from(position);
  const std::optional<Point> to = route.to(position);
  const double before = MovesAround(layer, from, present, to);
  int best = present;
  double least = before - kImprovementTolerance;
  for (int e = layer.table.first(path); e < layer.table.first(path + 1); ++e) {
    if (const double moves = MovesAround(layer, from, e, to, least); moves < least) {
      least = moves;
      best = e;
    }
  }
  if (best == present) return 0;
  route.SetEntry(position, best);
  // Its neighbors are worth a look now, but it is not.
  route.TakePendingVisit(path);
  return least - before;
}

}  // namespace

double PointReleaseDelta(const SearchRoute& route, int position, int entry) {
  assert(0 <= position && position < route.size());
  assert(route.layer().table.path_of(entry) == route.layer().table.path_of(route.entry(position)));
  const Point from = route.from(position);
  const std::optional<Point> to = route.to(position);
  return MovesAround(route.layer(), from, entry, to) -
         MovesAround(route.layer(), from, route.entry(position), to);
}

double ReleasePoints(SearchRoute& route, Released released, Budget& budget) {
  const auto is_released = [&](int path) {
    return released == Released::kAll ||
           route.layer().plan().paths[static_cast<size_t>(path)].kind == Path::Kind::kOpen;
  };
  double change = 0;
  bool any = true;
  while (any) {
    any = false;
    for (int position = 0; position < route.size(); ++position) {
      const int path = route.layer().table.path_of(route.entry(position));
      if (!is_released(path) || !route.TakePendingVisit(path)) continue;
      if (budget.Exhausted()) return change;
      const double gain = ReleasePoint(route, position);
      change += gain;
      any = any || gain < 0;
    }
  }
  return change;
}

}  // namespace traverse
