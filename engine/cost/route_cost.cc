#include "engine/cost/route_cost.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/base/rest.h"
#include "engine/cost/link_cost.h"
#include "engine/cost/travel_cost.h"
#include "engine/cost/wall_cost.h"

namespace traverse {

namespace {

// Calls visit(from, to) for the moves to all visits, until it returns false; returns whether it
// never did.
template <typename VisitMove>
bool ForEachMove(const LayerProblem& problem, const Route& route, VisitMove visit_move) {
  Point at = problem.start;
  for (const Visit& visit : route) {
    assert(visit.path >= 0 && static_cast<size_t>(visit.path) < problem.plan->paths.size());
    const Path& path = problem.plan->paths[static_cast<size_t>(visit.path)];
    if (!visit_move(at, EnterPoint(path, visit.entry))) return false;
    at = ExitPoint(path, visit.entry);
  }
  return true;
}

double LinkedRouteCost(const LayerProblem& problem, const Route& route, Budget* budget) {
  Rest rest(budget);
  const bool asks_often = problem.walls != nullptr && budget != nullptr;
  const LinkCost cost(problem);
  LinkCost::Left left = cost.Before();
  double sum = 0;
  for (const Visit& visit : route) {
    rest(8);
    if (asks_often && budget->Exhausted() && budget->cancelled()) return sum;
    sum += cost.To(left, visit);
    left = cost.After(visit);
  }
  return sum + cost.ToFinish(left);
}

}  // namespace

double RouteCost(const LayerProblem& problem, const Route& route, Budget* budget) {
  if (problem.links != nullptr) return LinkedRouteCost(problem, route, budget);
  Rest rest(budget);
  const bool asks_often = problem.walls != nullptr && budget != nullptr;
  const TravelCost cost(problem);
  double sum = 0;
  const bool whole = ForEachMove(problem, route, [&](Point from, Point to) {
    rest(4);
    if (asks_often && budget->Exhausted() && budget->cancelled()) return false;
    sum += cost(from, to);
    return true;
  });
  if (whole && problem.finish)
    sum += cost(RouteEnd(*problem.plan, route, problem.start), *problem.finish);
  return sum;
}

double RouteCostInTime(const LayerProblem& problem, const Route& route, Budget& budget) {
  if (problem.walls == nullptr) return RouteCost(problem, route, &budget);
  // Some ten milliseconds; routes of real layers take less.
  constexpr int64_t kMostWork = 500'000;
  const TravelCost cost(problem);
  const int64_t before = problem.walls->work();
  double sum = 0;
  const bool whole = ForEachMove(problem, route, [&](Point from, Point to) {
    if (budget.Exhausted() && (budget.cancelled() || problem.walls->work() - before > kMostWork)) {
      return false;
    }
    sum += cost(from, to);
    return true;
  });
  if (!whole) return std::numeric_limits<double>::infinity();
  if (problem.finish) sum += cost(RouteEnd(*problem.plan, route, problem.start), *problem.finish);
  return sum;
}

double CrossingPrice(const LayerProblem& problem, const Route& route) {
  if (problem.walls == nullptr) return 0;
  double sum = 0;
  ForEachMove(problem, route, [&](Point from, Point to) {
    sum += problem.walls->PriceOf(from, to);
    return true;
  });
  return sum * problem.walls_unit;
}

Departure DepartureAfter(const LayerProblem& problem, const Route& route) {
  const LinkCost cost(problem);
  const LinkCost::Left left = route.empty() ? cost.Before() : cost.After(route.back());
  return {left.at, left.seconds};
}

Point RouteEnd(const Plan& plan, const Route& route, Point start) {
  if (route.empty()) return start;
  return ExitPoint(plan.paths[static_cast<size_t>(route.back().path)], route.back().entry);
}

}  // namespace traverse
