#include "engine/strategy/ni2opt.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

std::unique_ptr<Strategy> Ni2opt(const std::map<std::string, std::string>& options = {}) {
  return *MakeStrategy("ni2opt", options);
}

TEST(Ni2opt, FindsTheShortestWayThroughAPlate) {
  OwnedProblem owned(SequentialPlan({{PlateWithHoles()[0].contours, {}}}));
  Budget budget;

  const Solution solution = Ni2opt()->Solve(owned.problem, budget);

  EXPECT_NEAR(RouteCost(owned.problem, solution.route), BruteForce(owned.problem).cost, 1e-9);
  EXPECT_EQ(solution.stop, StopReason::kLocalOptimum);
}

TEST(Ni2opt, PointReleaseShortensRoutes) {
  double with = 0, without = 0;
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    const OwnedProblem owned = RandomProblem(
        seed,
        {.shape = PlanShape::kSequential, .min_paths = 20, .max_paths = 40, .max_vertices = 12});
    LayerProblem problem = owned.problem;
    problem.cost = {};
    Budget budget;
    with += RouteCost(problem, Ni2opt()->Solve(problem, budget).route);
    without +=
        RouteCost(problem, Ni2opt({{"point_release", "false"}})->Solve(problem, budget).route);
  }

  EXPECT_LT(with, 0.98 * without);
}

TEST(Ni2opt, ResumeImprovesARouteThatBeganElsewhere) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 30});
    Budget budget;
    const Solution elsewhere = Ni2opt()->Solve(owned.problem, budget);
    LayerProblem moved = owned.problem;
    moved.start = {moved.start.y, 100 - moved.start.x};

    const Solution resumed = Ni2opt()->Resume(moved, elsewhere.route, budget);

    const double cost = RouteCost(moved, resumed.route);
    EXPECT_LE(cost, RouteCost(moved, elsewhere.route));
    EXPECT_LE(cost, RouteCost(moved, (*MakeStrategy("greedy", {}))->Solve(moved, budget).route));
  }
}

}  // namespace
}  // namespace traverse
