#include "engine/cost/route_cost.h"

#include <cassert>
#include <cstddef>

#include "engine/cost/travel_cost.h"

namespace traverse {

double RouteCost(const LayerProblem& problem, const Route& route) {
  const TravelCost cost(problem);
  double sum = 0;
  Point at = problem.start;
  for (const Visit& visit : route) {
    assert(visit.path >= 0 && static_cast<size_t>(visit.path) < problem.plan->paths.size());
    const Path& path = problem.plan->paths[static_cast<size_t>(visit.path)];
    sum += cost(at, EnterPoint(path, visit.entry));
    at = ExitPoint(path, visit.entry);
  }
  if (problem.finish) sum += cost(at, *problem.finish);
  return sum;
}

Point RouteEnd(const Plan& plan, const Route& route, Point start) {
  if (route.empty()) return start;
  return ExitPoint(plan.paths[static_cast<size_t>(route.back().path)], route.back().entry);
}

}  // namespace traverse
