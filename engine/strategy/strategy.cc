#include "engine/strategy/strategy.h"

#include <cassert>
#include <utility>

#include "engine/cost/route_cost.h"

namespace traverse {

Solution Strategy::Resume(const LayerProblem& problem, const Route& start, Budget& budget) const {
  Solution solution = Solve(problem, budget);
  if (RouteCost(problem, start) < RouteCost(problem, solution.route)) solution.route = start;
  return solution;
}

Solution Strategy::ResumeWithNext(const LayerProblem& problem, const Route& start,
                                  [[maybe_unused]] const LayerProblem& next, Route& /*next_start*/,
                                  Budget& budget) const {
  assert(problem.cost == next.cost && !problem.finish);
  return Resume(problem, start, budget);
}

}  // namespace traverse
