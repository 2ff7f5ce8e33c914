#include "engine/exact/plan_stages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <utility>
#include <vector>

#include "tests/support/instances.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

constexpr size_t kNoLimit = 1000;

PlanNode Leaf(int path) { return PlanNode{PlanNode::Kind::kPath, path, {}, {}}; }
PlanNode InOrder(std::vector<int> children) {
  return PlanNode{PlanNode::Kind::kInOrder, 0, std::move(children), {}};
}
PlanNode AnyOrder(std::vector<int> children, std::vector<std::pair<int, int>> before = {}) {
  return PlanNode{PlanNode::Kind::kAnyOrder, 0, std::move(children), std::move(before)};
}
std::vector<Path> Dots(int count) {
  return std::vector<Path>(static_cast<size_t>(count), MakeContour({{0, 0}}));
}

TEST(StagesOf, SequentialDepositionHasTwo) {
  const auto stages = StagesOf(SequentialPlan(testing::SquareGrid(2, 1)), kNoLimit);

  ASSERT_TRUE(stages.has_value());
  ASSERT_THAT(*stages, SizeIs(2));
  EXPECT_THAT((*stages)[0].paths, ElementsAre(0, 2));
  EXPECT_THAT((*stages)[1].paths, ElementsAre(1, 3));
  EXPECT_THAT((*stages)[0].before, IsEmpty());
}

TEST(StagesOf, EmptyPlanHasNone) {
  const auto of_nothing = StagesOf(Plan{}, kNoLimit);
  const auto of_empty_nodes = StagesOf(Plan{{}, {AnyOrder({1}), InOrder({})}}, kNoLimit);

  ASSERT_TRUE(of_nothing.has_value());
  EXPECT_THAT(*of_nothing, IsEmpty());
  ASSERT_TRUE(of_empty_nodes.has_value());
  EXPECT_THAT(*of_empty_nodes, IsEmpty());
}

TEST(StagesOf, FlattensNodesWithOneChildAndNestedInOrders) {
  const Plan plan{Dots(3),
                  {InOrder({1, 4}), InOrder({2, 3}), Leaf(0), Leaf(1), AnyOrder({5}), InOrder({6}),
                   AnyOrder({7}), Leaf(2)}};

  const auto stages = StagesOf(plan, kNoLimit);

  ASSERT_TRUE(stages.has_value());
  ASSERT_THAT(*stages, SizeIs(3));
  EXPECT_THAT((*stages)[2].paths, ElementsAre(2));
}

TEST(StagesOf, KeepsPrecedencesThroughChildrenWithoutPaths) {
  const Plan plan{
      Dots(3),
      {AnyOrder({1, 2, 3, 4}, {{3, 1}, {1, 0}, {0, 2}}), Leaf(0), InOrder({}), Leaf(1), Leaf(2)}};

  const auto stages = StagesOf(plan, kNoLimit);

  ASSERT_TRUE(stages.has_value());
  ASSERT_THAT(*stages, SizeIs(1));
  EXPECT_THAT((*stages)[0].before, UnorderedElementsAre(Pair(2, 0), Pair(2, 1), Pair(0, 1)));
}

TEST(StagesOf, RefusesBlocksInAnyOrderAndLargeNodes) {
  EXPECT_FALSE(StagesOf(InterleavedPlan(testing::SquareGrid(2, 1)), kNoLimit).has_value());
  EXPECT_FALSE(StagesOf(testing::FlatPlan(4), 3).has_value());
}

}  // namespace
}  // namespace traverse
