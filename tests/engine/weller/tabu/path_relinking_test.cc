#include "engine/weller/tabu/path_relinking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "engine/cost/route_cost.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/owned_problem.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::OwnedProblem;

Route OfPaths(const std::vector<int>& order) {
  Route route;
  for (const int path : order) route.push_back({path, 0});
  return route;
}

// Points 0, 1, 2, 3 on a line. From 3 1 0 2 to 0 1 2 3 it takes two swaps; 3 <-> 0 gives 0 1 3 2 of
// 4 mm, 3 <-> 2 would give 2 1 0 3 of 7 mm.
TEST(PathRelinking, TakesTheCheapestStepTowardsTheGuide) {
  const OwnedProblem owned(testing::FlatPlan(4));
  Budget budget;

  const std::vector<Route> between =
      RelinkPaths(owned.problem, {}, OfPaths({3, 1, 0, 2}), OfPaths({0, 1, 2, 3}), 5, budget);

  EXPECT_THAT(between, ElementsAre(OfPaths({0, 1, 3, 2})));
}

TEST(PathRelinking, KeepsTheBestBestFirst) {
  const OwnedProblem owned(testing::FlatPlan(9));
  Budget budget;
  const Route from = OfPaths({4, 8, 0, 6, 2, 7, 1, 5, 3});
  const Route guide = OfPaths({0, 1, 2, 3, 4, 5, 6, 7, 8});

  const std::vector<Route> all = RelinkPaths(owned.problem, {}, from, guide, 100, budget);
  const std::vector<Route> best = RelinkPaths(owned.problem, {}, from, guide, 2, budget);

  ASSERT_GE(all.size(), 3u);
  for (size_t i = 1; i < all.size(); ++i) {
    EXPECT_GE(RouteCost(owned.problem, all[i]), RouteCost(owned.problem, all[i - 1]));
  }
  for (const Route& route : all) {
    EXPECT_NE(route, from);
    EXPECT_NE(route, guide);
  }
  EXPECT_THAT(best, ElementsAre(all[0], all[1]));
}

TEST(PathRelinking, KeepsNoneIfNoneIsWanted) {
  const OwnedProblem owned(testing::FlatPlan(9));
  Budget budget;

  EXPECT_THAT(RelinkPaths(owned.problem, {}, OfPaths({4, 8, 0, 6, 2, 7, 1, 5, 3}),
                          OfPaths({0, 1, 2, 3, 4, 5, 6, 7, 8}), 0, budget),
              IsEmpty());
}

TEST(PathRelinking, OfEqualOrTrivialSequences) {
  const OwnedProblem one(testing::FlatPlan(1));
  const OwnedProblem three(testing::FlatPlan(3));
  Budget budget;

  EXPECT_THAT(RelinkPaths(one.problem, {}, OfPaths({0}), OfPaths({0}), 5, budget), IsEmpty());
  EXPECT_THAT(RelinkPaths(three.problem, {}, OfPaths({2, 1, 0}), OfPaths({2, 1, 0}), 5, budget),
              IsEmpty());
}

}  // namespace
}  // namespace traverse
