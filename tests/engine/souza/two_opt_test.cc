#include "engine/souza/two_opt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/model/tree/plan_tree.h"
#include "tests/support/problems/instances.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using namespace traverse::testing;  // NOLINT

const Precedence kFree;

std::vector<Block> PointsAt(const std::vector<Point>& points) {
  std::vector<Block> blocks;
  for (const Point p : points) blocks.push_back({p, p, static_cast<int>(blocks.size()), true});
  return blocks;
}

//   0---1         0   1
//     X     ->    |   |
//   2---3         2---3
TEST(TwoOpt, UncrossesTwoMoves) {
  BlockLine line((TravelCost({})));
  line.Load({0, 2}, std::nullopt, PointsAt({{0, 1}, {1, 0}, {0, 0}, {1, 1}}), kFree);
  Budget budget;

  const double change = TwoOpt(line, budget);

  EXPECT_THAT(line.slots(), ElementsAre(0, 2, 1, 3));
  EXPECT_DOUBLE_EQ(line.Cost(), 4);
  EXPECT_NEAR(change, 4 - (2 + 2 * std::sqrt(2.0)), 1e-12);
}

TEST(TwoOpt, TurnsASingleRasterRound) {
  BlockLine line((TravelCost({})));
  line.Load({0, 0}, Point{9, 0}, {{{8, 0}, {1, 0}, 0, true}}, kFree);
  Budget budget;

  EXPECT_DOUBLE_EQ(TwoOpt(line, budget), 2 - 16);
  EXPECT_THAT(line.reversed(), ElementsAre(1));
}

TEST(TwoOpt, LeavesAOneWayPathAsItIs) {
  BlockLine line((TravelCost({})));
  line.Load({0, 0}, Point{9, 0}, {{{8, 0}, {1, 0}, 0, false}}, kFree);
  Budget budget;

  EXPECT_EQ(TwoOpt(line, budget), 0);
  EXPECT_THAT(line.reversed(), ElementsAre(0));
}

TEST(TwoOpt, KeepsPrecedenceEvenThoughItCosts) {
  Plan plan = FlatPlan(3);
  plan.nodes[0].before = {{2, 0}};
  const PlanTree tree(plan);
  BlockLine line((TravelCost({})));
  // Slots 2, 1, 0 at x = 3, 2, 1: the way back would be the shorter one.
  line.Load({0, 0}, std::nullopt,
            {{{3, 0}, {3, 0}, 2, true}, {{2, 0}, {2, 0}, 1, true}, {{1, 0}, {1, 0}, 0, true}},
            tree.precedence(0));
  Budget budget;

  EXPECT_EQ(TwoOpt(line, budget), 0);
  EXPECT_THAT(line.slots(), ElementsAre(2, 1, 0));
}

TEST(TwoOpt, StopsAtOnceWhenCancelled) {
  BlockLine line((TravelCost({})));
  line.Load({0, 2}, std::nullopt, PointsAt({{0, 1}, {1, 0}, {0, 0}, {1, 1}}), kFree);
  CancelToken cancelled;
  cancelled.Cancel();
  Budget budget(&cancelled);

  EXPECT_EQ(TwoOpt(line, budget), 0);
}

TEST(TwoOpt, OfNoBlocksDoesNothing) {
  BlockLine line((TravelCost({})));
  line.Load({0, 0}, Point{1, 0}, {}, kFree);
  Budget budget;

  EXPECT_EQ(TwoOpt(line, budget), 0);
}

}  // namespace
}  // namespace traverse
