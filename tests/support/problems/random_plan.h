// Seeded random plans and problems for property tests.
//
//   for (uint64_t seed = 1; seed <= 200; ++seed) {
//     SCOPED_TRACE(absl::StrCat("seed ", seed));
//     const OwnedProblem owned = RandomProblem(seed, {.max_paths = 7});
//     ...
//   }

#ifndef TRAVERSE_TESTS_SUPPORT_PROBLEMS_RANDOM_PLAN_H_
#define TRAVERSE_TESTS_SUPPORT_PROBLEMS_RANDOM_PLAN_H_

#include <cstdint>
#include <optional>

#include "engine/base/rng.h"
#include "engine/model/cost_spec.h"
#include "engine/model/plan.h"
#include "tests/support/problems/owned_problem.h"

namespace traverse::testing {

enum class PlanShape {
  kFlatContours,  // any_order(contours)
  kSequential,    // SequentialPlan of islands
  kInterleaved,   // InterleavedPlan of islands
  kFlatBefore,    // any_order(contours and open paths, before)
  kTree,          // nested in_order and any_order with `before`, nodes without paths among them
};

struct RandomPlanOptions {
  std::optional<PlanShape> shape = std::nullopt;  // unset: any, by the seed
  int min_paths = 0;
  int max_paths = 7;
  int max_vertices = 5;  // of a contour

  // One-travel paths, fixed and limited entries, one-point contours, repeated vertices, zero-length
  // open paths, points that coincide (on a grid of whole millimetres).
  bool special = true;
};

// A plan that passes CheckPlan, the same for the same arguments.
Plan RandomPlan(uint64_t seed, const RandomPlanOptions& options = {});

// A contour or an open path with its points in [0, 100] x [0, 100].
Path RandomContour(Rng& rng, const RandomPlanOptions& options = {});
Path RandomOpenPath(Rng& rng, const RandomPlanOptions& options = {});

// Length, or time with or without acceleration and retraction.
CostSpec RandomCost(Rng& rng);

// A random plan with a random start and cost, every third time with a finish.
OwnedProblem RandomProblem(uint64_t seed, const RandomPlanOptions& options = {});

// What makes many routes cost the same, or moves cost nothing.
enum class Degeneracy {
  kCoincident,  // all points are one
  kCollinear,   // all points are on a line
  kCoarseGrid,  // all points are on a grid of nine
  kDuplicates,  // contours are copies of one, and so are open paths
  kZeroLength,  // open paths end where they begin
};
inline constexpr Degeneracy kDegeneracies[] = {Degeneracy::kCoincident, Degeneracy::kCollinear,
                                               Degeneracy::kCoarseGrid, Degeneracy::kDuplicates,
                                               Degeneracy::kZeroLength};

// The same problem with other points.
OwnedProblem Degenerate(const OwnedProblem& owned, Degeneracy degeneracy);

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_PROBLEMS_RANDOM_PLAN_H_
