#include "engine/weller/tabu/point_relinking.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/weller/steps/contour_route.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/owned_problem.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

struct Case {
  explicit Case(uint64_t seed)
      : owned(testing::RandomProblem(seed, {.shape = testing::PlanShape::kFlatContours,
                                            .min_paths = 1,
                                            .max_paths = 8,
                                            .max_vertices = 6,
                                            .special = false})) {
    owned.problem.finish.reset();
    sequence.plan = &owned.plan();
    sequence.start = owned.problem.start;
    for (int p = 0; p < static_cast<int>(owned.plan().paths.size()); ++p) {
      sequence.order.push_back(p);
      std::vector<int>& vertices = sequence.vertices.emplace_back();
      const Path& path = owned.plan().paths[static_cast<size_t>(p)];
      for (int v = 0; v < static_cast<int>(path.points.size()); ++v) vertices.push_back(v);
      near.push_back(path.points.front());
    }
  }

  double Relinked(int rounds) const {
    Rng rng(1);
    Budget budget;
    return RouteCost(owned.problem, RelinkPoints(sequence, near, TravelCost(owned.problem.cost),
                                                 rounds, rng, budget));
  }

  OwnedProblem owned;
  SequencedPoints sequence;
  std::vector<Point> near;
};

TEST(RelinkPoints, BeginsWithThePointsNearestToThePreliminarySequence) {
  const Case any(3);
  Rng rng(1);
  Budget budget;

  const Route route =
      RelinkPoints(any.sequence, any.near, TravelCost(any.owned.problem.cost), 0, rng, budget);

  for (const Visit& visit : route) EXPECT_EQ(visit.entry, 0);
}

TEST(RelinkPoints, ComesNearToTheBestPoints) {
  double first = 0, relinked = 0, best = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Case any(seed);
    const double exact =
        RouteCost(any.owned.problem,
                  ChooseContourPoints(any.owned.plan(), any.sequence.order, any.sequence.vertices,
                                      any.sequence.start, TravelCost(any.owned.problem.cost)));
    EXPECT_GE(any.Relinked(200), exact - 1e-9);
    EXPECT_LE(any.Relinked(200), any.Relinked(0) + 1e-9);
    first += any.Relinked(0);
    relinked += any.Relinked(200);
    best += exact;
  }
  EXPECT_LT(relinked, 1.01 * best);
  EXPECT_GT(first, 1.05 * best);
}

}  // namespace
}  // namespace traverse
