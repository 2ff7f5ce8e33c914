// The optimum of a small problem, found by trying everything. Shares no code with the engine's
// algorithms.

#ifndef TRAVERSE_TESTS_SUPPORT_PROBLEMS_BRUTE_FORCE_H_
#define TRAVERSE_TESTS_SUPPORT_PROBLEMS_BRUTE_FORCE_H_

#include <functional>
#include <vector>

#include "engine/model/layer_problem.h"
#include "engine/model/route.h"

namespace traverse::testing {

struct BruteForceResult {
  double cost = 0;  // in the unit of problem.cost, the move to `finish` included
  Route route;
};

// Every order of the paths that `plan` allows; there may be repetitions. Up to 8 paths that are
// free against each other: 8! orders.
std::vector<std::vector<int>> LegalOrders(const Plan& plan);

// The cost of a travel move, where the one below is not meant.
using MoveFunction = std::function<double(Point from, Point to)>;

// The best entries for one order of the paths.
BruteForceResult BestEntries(const LayerProblem& problem, const std::vector<int>& order,
                             const MoveFunction& cost = nullptr);

// The best route over all legal orders and all entries.
BruteForceResult BruteForce(const LayerProblem& problem, const MoveFunction& cost = nullptr);

// The cost of one travel move, computed as SPEC and CostSpec state it.
double MoveCost(const CostSpec& spec, Point from, Point to);

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_PROBLEMS_BRUTE_FORCE_H_
