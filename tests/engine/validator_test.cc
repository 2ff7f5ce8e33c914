#include "engine/validator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using ::testing::HasSubstr;
using namespace traverse::testing;  // NOLINT

std::string Reason(const Plan& plan, const Route& route) {
  return std::string(ValidateRoute(plan, route).message());
}

TEST(ValidateRoute, AcceptsTheGivenOrderOfAnyPlan) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = RandomPlan(seed, {.max_paths = 30});

    EXPECT_OK(ValidateRoute(plan, GivenRoute(plan)));
  }
}

TEST(ValidateRoute, AcceptsAnOrderExactlyIfTheTreeAllowsIt) {
  for (uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = RandomPlan(seed, {.max_paths = 5});
    const std::vector<std::vector<int>> legal = LegalOrders(plan);
    std::vector<int> order;
    for (int p = 0; p < static_cast<int>(plan.paths.size()); ++p) order.push_back(p);

    do {
      Route route;
      for (const int p : order) {
        route.push_back({p, GivenEntry(plan.paths[static_cast<size_t>(p)])});
      }
      EXPECT_EQ(ValidateRoute(plan, route).ok(),
                std::find(legal.begin(), legal.end(), order) != legal.end());
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(ValidateRoute, NamesThePathVisitedTwiceOrNever) {
  const Plan plan = FlatPlan(3);

  EXPECT_EQ(Reason(plan, {{0, 0}, {1, 0}, {0, 0}}), "route[2]: path 0 was visited before");
  EXPECT_EQ(Reason(plan, {{0, 0}, {2, 0}}), "path 1 is not visited");
  EXPECT_EQ(Reason(plan, {{0, 0}, {3, 0}, {1, 0}}), "route[1]: there is no path 3");
  EXPECT_EQ(Reason(plan, {{-1, 0}}), "route[0]: there is no path -1");
}

TEST(ValidateRoute, NamesTheEntryThatIsNotAllowed) {
  const Plan plan =
      AnyOrderPlan({MakeContour({{0, 0}, {1, 0}, {2, 0}}, {2}), MakeOpenPath({0, 0}, {1, 1}, true),
                    MakeOpenPath({0, 0}, {1, 1})});

  EXPECT_OK(ValidateRoute(plan, {{0, 2}, {1, 0}, {2, 1}}));
  EXPECT_EQ(Reason(plan, {{0, 1}, {1, 0}, {2, 1}}), "route[0]: path 0 cannot be entered at 1");
  EXPECT_EQ(Reason(plan, {{0, 3}, {1, 0}, {2, 1}}), "route[0]: path 0 cannot be entered at 3");
  EXPECT_EQ(Reason(plan, {{0, 2}, {1, 1}, {2, 1}}), "route[1]: path 1 cannot be entered at 1");
  EXPECT_EQ(Reason(plan, {{0, 2}, {1, 0}, {2, -1}}), "route[2]: path 2 cannot be entered at -1");
  EXPECT_EQ(Reason(plan, {{0, 2}, {1, 0}, {2, 2}}), "route[2]: path 2 cannot be entered at 2");
}

TEST(ValidateRoute, NamesTheNodeThatWasInterrupted) {
  const Plan plan = InterleavedPlan(SquareGrid(2, 1));
  const Route route = {{0, 0}, {2, 0}, {1, 0}, {3, 0}};

  EXPECT_THAT(Reason(plan, route), HasSubstr("other paths come between its own"));
}

TEST(ValidateRoute, NamesTheChildThatIsTooEarly) {
  const Plan plan = SequentialPlan(SquareGrid(1, 1));

  EXPECT_EQ(Reason(plan, {{1, 0}, {0, 0}}), "nodes[0].in_order: child 1 comes too early");
}

TEST(ValidateRoute, KeepsPairsThroughAChildWithoutPaths) {
  Plan plan = FlatPlan(2);
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
  plan.nodes[0].children.push_back(3);
  plan.nodes[0].before = {{1, 2}, {2, 0}};
  ASSERT_OK(CheckPlan(plan));

  EXPECT_OK(ValidateRoute(plan, {{1, 0}, {0, 0}}));
  EXPECT_EQ(Reason(plan, {{0, 0}, {1, 0}}),
            "nodes[0].any_order: child 0 comes before one that must precede it");
}

TEST(MeasureTravel, SplitsByTheKindOfMove) {
  const Plan plan = AnyOrderPlan({MakeContour({{3, 4}}), MakeContour({{3, 5}}),
                                  MakeOpenPath({3, 7}, {10, 7}), MakeOpenPath({20, 7}, {13, 7})});

  const TravelSplit split = MeasureTravel(plan, {0, 0}, {{0, 0}, {1, 0}, {2, 0}, {3, 1}});

  EXPECT_DOUBLE_EQ(split.contours_mm, 5 + 1);
  EXPECT_DOUBLE_EQ(split.links_mm, 2);
  EXPECT_DOUBLE_EQ(split.rasters_mm, 3);
}

TEST(MeasureTravel, TotalIsTheRouteCostInLength) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    OwnedProblem owned = RandomProblem(seed, {.max_paths = 20});
    owned.problem.cost = {};
    owned.problem.finish.reset();
    const Route route = GivenRoute(owned.plan());

    EXPECT_NEAR(MeasureTravel(owned.plan(), owned.problem.start, route).total_mm(),
                RouteCost(owned.problem, route), 1e-9);
  }
}

}  // namespace
}  // namespace traverse
