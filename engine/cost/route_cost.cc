#include "engine/cost/route_cost.h"

#include <cassert>
#include <cstddef>

#include "engine/base/rest.h"
#include "engine/cost/travel_cost.h"
#include "engine/cost/wall_cost.h"

namespace traverse {

double RouteCost(const LayerProblem& problem, const Route& route, Budget* budget) {
  Rest rest(budget);
  const bool asks_often = problem.walls != nullptr && budget != nullptr;
  const TravelCost cost(problem);
  double sum = 0;
  Point at = problem.start;
  for (const Visit& visit : route) {
    rest(4);
    if (asks_often && budget->Exhausted() && budget->cancelled()) return sum;
    assert(visit.path >= 0 && static_cast<size_t>(visit.path) < problem.plan->paths.size());
    const Path& path = problem.plan->paths[static_cast<size_t>(visit.path)];
    sum += cost(at, EnterPoint(path, visit.entry));
    at = ExitPoint(path, visit.entry);
  }
  if (problem.finish) sum += cost(at, *problem.finish);
  return sum;
}

double CrossingPrice(const LayerProblem& problem, const Route& route) {
  if (problem.walls == nullptr) return 0;
  double sum = 0;
  Point at = problem.start;
  for (const Visit& visit : route) {
    assert(visit.path >= 0 && static_cast<size_t>(visit.path) < problem.plan->paths.size());
    const Path& path = problem.plan->paths[static_cast<size_t>(visit.path)];
    sum += problem.walls->PriceOf(at, EnterPoint(path, visit.entry));
    at = ExitPoint(path, visit.entry);
  }
  return sum * problem.walls_unit;
}

Point RouteEnd(const Plan& plan, const Route& route, Point start) {
  if (route.empty()) return start;
  return ExitPoint(plan.paths[static_cast<size_t>(route.back().path)], route.back().entry);
}

}  // namespace traverse
