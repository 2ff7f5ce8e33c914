// Small random problems for the programmes of the thesis.

#ifndef TRAVERSE_TESTS_ENGINE_WELLER_MILP_MILP_PROBLEMS_H_
#define TRAVERSE_TESTS_ENGINE_WELLER_MILP_MILP_PROBLEMS_H_

#include <utility>
#include <vector>

#include "engine/base/rng.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {

inline constexpr double kMilpTolerance = 1e-6;

inline testing::OwnedProblem MilpProblem(Plan plan, Rng& rng) {
  testing::OwnedProblem owned(std::move(plan), {100 * rng.Unit(), 100 * rng.Unit()});
  owned.problem.cost = testing::RandomCost(rng);
  return owned;
}

inline testing::OwnedProblem ContourProblem(Rng& rng, int contours) {
  std::vector<Path> paths;
  for (int i = 0; i < contours; ++i) {
    Path path = testing::RandomContour(rng, {.max_vertices = 4});
    path.allowed.clear();
    paths.push_back(std::move(path));
  }
  return MilpProblem(testing::AnyOrderPlan(std::move(paths)), rng);
}

}  // namespace traverse

#endif  // TRAVERSE_TESTS_ENGINE_WELLER_MILP_MILP_PROBLEMS_H_
