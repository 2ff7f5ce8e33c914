// The thesis's programme of contours against brute force: engine/weller/milp/contour_milp.

#include "engine/weller/milp/contour_milp.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/engine/weller/milp/milp_problems.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

SymmetricRelation AllLinked(int nodes) {
  SymmetricRelation linked(nodes);
  for (int i = 0; i < nodes; ++i) {
    for (int j = i + 1; j < nodes; ++j) linked.Link(i, j);
  }
  return linked;
}

TEST(ContourMilp, IsTheBestSequence) {
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const int contours = rng.Between(1, 4);
    const OwnedProblem owned = ContourProblem(rng, contours);
    const double best = testing::BruteForce(owned.problem).cost;
    for (const bool strengthened : {false, true}) {
      Budget budget;

      const MilpRoute found = SolveContourMilp(owned.problem, AllLinked(contours + 1), {},
                                               {.gap = 0, .strengthened = strengthened}, budget);

      EXPECT_TRUE(found.complete);
      ASSERT_OK(ValidateRoute(owned.plan(), found.route));
      EXPECT_NEAR(RouteCost(owned.problem, found.route), best, kMilpTolerance * (1 + best));
      EXPECT_NEAR(found.value, best, kMilpTolerance * (1 + best));
    }
  }
}

// Contours in a row, of which only those further apart are linked: 0 - 2 - 1 - 3 from the left.
TEST(ContourMilp, KeepsToNeighbors) {
  const OwnedProblem owned(testing::FlatPlan(4));
  SymmetricRelation linked(5);
  linked.Link(4, 0);
  linked.Link(0, 2);
  linked.Link(2, 1);
  linked.Link(1, 3);
  Budget budget;

  const MilpRoute free = SolveContourMilp(owned.problem, linked, {}, {.gap = 0}, budget);
  const MilpRoute known =
      SolveContourMilp(owned.problem, linked, GivenRoute(owned.plan()), {.gap = 0}, budget);

  EXPECT_EQ(free.route, (Route{{0, 0}, {2, 0}, {1, 0}, {3, 0}}));
  EXPECT_EQ(known.route, GivenRoute(owned.plan()));  // whose moves count as neighbors
}

TEST(ContourMilp, SaysWhenNeighborsLeaveNoSequence) {
  const OwnedProblem owned(testing::FlatPlan(3));
  SymmetricRelation linked(4);
  linked.Link(3, 0);
  linked.Link(0, 1);
  Budget budget;

  const MilpRoute found = SolveContourMilp(owned.problem, linked, {}, {.gap = 0}, budget);

  EXPECT_TRUE(found.complete);
  EXPECT_TRUE(found.route.empty());
}

}  // namespace
}  // namespace traverse
