// The thesis's programme of rasters against brute force: engine/weller/milp/raster_milp.

#include "engine/weller/milp/raster_milp.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "engine/weller/milp/contour_milp.h"
#include "tests/engine/weller/milp/milp_problems.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

// any_order over groups of any_order over open paths.
OwnedProblem RasterProblem(Rng& rng, std::vector<int>& group_of) {
  Plan plan;
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
  const int groups = rng.Between(1, 3);
  for (int group = 0; group < groups; ++group) {
    const size_t parent = plan.nodes.size();
    plan.nodes[0].children.push_back(static_cast<int>(parent));
    plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
    for (int i = rng.Between(1, 2); i > 0; --i) {
      plan.nodes[parent].children.push_back(static_cast<int>(plan.nodes.size()));
      plan.nodes.push_back(
          PlanNode{PlanNode::Kind::kPath, static_cast<int>(plan.paths.size()), {}, {}});
      plan.paths.push_back(testing::RandomOpenPath(rng));
      group_of.push_back(group);
    }
  }
  OwnedProblem owned = MilpProblem(std::move(plan), rng);
  if (rng.Between(0, 1) == 1) owned.problem.finish = Point{50, 50};
  return owned;
}

TEST(RasterMilp, IsTheBestRouteThatKeepsIslandsTogether) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    std::vector<int> group_of;
    const OwnedProblem owned = RasterProblem(rng, group_of);
    const double best = testing::BruteForce(owned.problem).cost;
    Budget budget;

    const MilpRoute found =
        SolveRasterMilp(owned.problem, {group_of, -1, nullptr}, {}, {.gap = 0}, budget);

    EXPECT_TRUE(found.complete);
    ASSERT_OK(ValidateRoute(owned.plan(), found.route));
    EXPECT_NEAR(RouteCost(owned.problem, found.route), best, kMilpTolerance * (1 + best));
    EXPECT_NEAR(found.value, best, kMilpTolerance * (1 + best));
  }
}

// Three islands in a row; the first and the second are no neighbors.
TEST(RasterMilp, KeepsToNeighboringIslands) {
  const OwnedProblem owned(testing::AnyOrderPlan(
      {MakeOpenPath({1, 0}, {1, 5}), MakeOpenPath({2, 0}, {2, 5}), MakeOpenPath({3, 0}, {3, 5})}));
  SymmetricRelation linked(3);
  linked.Link(0, 2);
  linked.Link(1, 2);
  Budget budget;

  const MilpRoute found =
      SolveRasterMilp(owned.problem, {{0, 1, 2}, 0, &linked}, {}, {.gap = 0}, budget);

  EXPECT_EQ(found.route, (Route{{0, 0}, {2, 1}, {1, 0}}));
}

}  // namespace
}  // namespace traverse
