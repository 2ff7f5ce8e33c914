#include "engine/strategy/strategy.h"

#include <utility>

#include "engine/cost/route_cost.h"

namespace traverse {

Solution Strategy::Resume(const LayerProblem& problem, const Route& start, Budget& budget) const {
  Solution solution = Solve(problem, budget);
  if (RouteCost(problem, start) < RouteCost(problem, solution.route)) solution.route = start;
  return solution;
}

}  // namespace traverse
