// The cost of a whole route.

#ifndef TRAVERSE_ENGINE_COST_ROUTE_COST_H_
#define TRAVERSE_ENGINE_COST_ROUTE_COST_H_

#include "engine/model/layer_problem.h"
#include "engine/model/route.h"

namespace traverse {

// Sum of the costs of all moves of `route`, in the unit of problem.cost, including the move to
// `finish`, and with `links`, if the problem has them. Asks `budget` regularly, if it is not null;
// among walls, where each move may take long, stops once that is cancelled. REQUIRES: the visits
// are of paths of the problem's plan; they need not be all of them.
double RouteCost(const LayerProblem& problem, const Route& route, Budget* budget = nullptr);

// The same, but infinite if `budget` is exhausted and what is left takes much longer. Only among
// walls that many moves cross can it take so long. For costs that are only to be compared.
double RouteCostInTime(const LayerProblem& problem, const Route& route, Budget& budget);

// What of that cost is the price of crossed walls (WallCost::PriceOf), in the same unit. REQUIRES:
// as above.
double CrossingPrice(const LayerProblem& problem, const Route& route);

// How the head leaves the last path of `route`: Departure::from is set, also without links. For an
// empty route as it came to the start.
Departure DepartureAfter(const LayerProblem& problem, const Route& route);

// Where the head is after `route`, without links: the last exit, or `start` for an empty route.
Point RouteEnd(const Plan& plan, const Route& route, Point start);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_ROUTE_COST_H_
