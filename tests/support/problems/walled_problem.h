// Seeded random problems with walls, and what their moves cost, computed by brute force.

#ifndef TRAVERSE_TESTS_SUPPORT_PROBLEMS_WALLED_PROBLEM_H_
#define TRAVERSE_TESTS_SUPPORT_PROBLEMS_WALLED_PROBLEM_H_

#include <cstdint>
#include <memory>

#include "engine/cost/wall_cost.h"
#include "engine/model/walls.h"
#include "tests/support/problems/owned_problem.h"
#include "tests/support/problems/random_plan.h"

namespace traverse::testing {

// Movable; `owned.problem` stays valid.
struct WalledProblem {
  OwnedProblem owned;
  LayerWalls walls;
  std::unique_ptr<const WallCost> cost;

  const LayerProblem& problem() const { return owned.problem; }
};

// Around [0, 100] x [0, 100]: polylines and loops, some of them outlines of paths.
LayerWalls RandomWalls(Rng& rng, const Plan& plan);

// A time with retractions, lifts and prices. Without travel moves around walls.
CostSpec RandomWallSpec(Rng& rng);

// A problem of its own with walls and such a cost. `around`: travel moves may lead around walls.
WalledProblem RandomWalledProblem(uint64_t seed, const RandomPlanOptions& options = {},
                                  bool around = false);

// The same problem with everything turned and moved.
WalledProblem Turned(const WalledProblem& walled, double angle, Point by);

// Whether the travel between two points crosses a wall, and what the straight move costs, as
// walls.h and cost_spec.h state it. Every segment is looked at.
bool CrossesAny(const LayerWalls& walls, double slack_mm, Point from, Point to);
double WalledMoveCost(const WalledProblem& walled, Point from, Point to);

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_PROBLEMS_WALLED_PROBLEM_H_
