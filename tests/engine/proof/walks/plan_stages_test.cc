#include "engine/proof/walks/plan_stages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

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

std::vector<std::pair<int, int>> Follows(const PlanStage& stage) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < stage.size(); ++i) {
    for (int j = 0; j < stage.size(); ++j) {
      if (stage.CanFollow(i, j)) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

// All orders of one stage that follow its moves, each item once, as paths.
void ExtendOrders(const PlanStage& stage, std::vector<int>& items,
                  std::vector<std::vector<int>>& found) {
  if (static_cast<int>(items.size()) == stage.size()) {
    if (stage.ends[static_cast<size_t>(items.back())] == 0) return;
    std::vector<int>& order = found.emplace_back();
    for (const int item : items) {
      const int path = stage.paths[static_cast<size_t>(item)];
      if (path != PlanStage::kGate) order.push_back(path);
    }
    return;
  }
  for (int item = 0; item < stage.size(); ++item) {
    const bool may = items.empty() ? stage.begins[static_cast<size_t>(item)] != 0
                                   : stage.CanFollow(items.back(), item);
    if (!may || std::count(items.begin(), items.end(), item) > 0) continue;
    const bool too_late =
        std::any_of(stage.before.begin(), stage.before.end(), [&](const std::pair<int, int>& pair) {
          return pair.first == item && std::count(items.begin(), items.end(), pair.second) > 0;
        });
    if (too_late) continue;
    items.push_back(item);
    ExtendOrders(stage, items, found);
    items.pop_back();
  }
}

std::set<std::vector<int>> OrdersOf(const std::deque<PlanStage>& stages) {
  std::set<std::vector<int>> orders = {{}};
  for (const PlanStage& stage : stages) {
    std::vector<int> items;
    std::vector<std::vector<int>> of_stage;
    ExtendOrders(stage, items, of_stage);
    std::set<std::vector<int>> longer;
    for (const std::vector<int>& head : orders) {
      for (const std::vector<int>& tail : of_stage) {
        std::vector<int> order = head;
        order.insert(order.end(), tail.begin(), tail.end());
        longer.insert(std::move(order));
      }
    }
    orders = std::move(longer);
  }
  return orders;
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

TEST(StagesOf, BlocksAreEnteredAtTheirFirstPathAndLeftAtTheirLast) {
  // any_order(in_order(0, any_order(1, 2)), in_order(3, 4))
  const Plan plan{Dots(5),
                  {AnyOrder({1, 6}), InOrder({2, 3}), Leaf(0), AnyOrder({4, 5}), Leaf(1), Leaf(2),
                   InOrder({7, 8}), Leaf(3), Leaf(4)}};

  const auto stages = StagesOf(plan, kNoLimit);

  ASSERT_TRUE(stages.has_value());
  ASSERT_THAT(*stages, SizeIs(1));
  const PlanStage& stage = stages->front();
  EXPECT_THAT(stage.paths, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(Follows(stage), UnorderedElementsAre(Pair(0, 1), Pair(0, 2), Pair(1, 2), Pair(2, 1),
                                                   Pair(1, 3), Pair(2, 3), Pair(3, 4), Pair(4, 0)));
  EXPECT_THAT(stage.begins, ElementsAre(1, 0, 0, 1, 0));
  EXPECT_THAT(stage.ends, ElementsAre(0, 1, 1, 0, 1));
  EXPECT_THAT(stage.before, UnorderedElementsAre(Pair(0, 1), Pair(0, 2), Pair(3, 4)));
  EXPECT_THAT(stage.gates, IsEmpty());
}

TEST(StagesOf, BlocksWithoutAFirstOrLastPathGetAGate) {
  // any_order(any_order(0, 1), 2)
  const Plan plan{Dots(3), {AnyOrder({1, 4}), AnyOrder({2, 3}), Leaf(0), Leaf(1), Leaf(2)}};

  const auto stages = StagesOf(plan, kNoLimit);

  ASSERT_TRUE(stages.has_value());
  ASSERT_THAT(*stages, SizeIs(1));
  const PlanStage& stage = stages->front();
  EXPECT_THAT(stage.paths, ElementsAre(0, 1, PlanStage::kGate, 2));
  EXPECT_THAT(Follows(stage), UnorderedElementsAre(Pair(2, 0), Pair(2, 1), Pair(0, 1), Pair(1, 0),
                                                   Pair(0, 3), Pair(1, 3), Pair(3, 2)));
  EXPECT_THAT(stage.begins, ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(stage.before, UnorderedElementsAre(Pair(2, 0), Pair(2, 1)));
}

TEST(StagesOf, WhatHasToComeBetweenKeepsPathsApart) {
  const Plan plan{Dots(3), {AnyOrder({1, 2, 3}, {{0, 1}, {1, 2}}), Leaf(0), Leaf(1), Leaf(2)}};

  const auto stages = StagesOf(plan, kNoLimit);

  ASSERT_TRUE(stages.has_value());
  EXPECT_THAT(Follows(stages->front()), UnorderedElementsAre(Pair(0, 1), Pair(1, 2)));
}

// What the header promises: item orders that keep these rules are the plan's orders, and all of
// them.
TEST(StagesOf, OrdersThatFollowTheRulesAreThoseOfThePlan) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = testing::RandomPlan(
        seed,
        {.shape = seed % 2 == 0 ? testing::PlanShape::kTree : testing::PlanShape::kInterleaved,
         .min_paths = 1,
         .max_paths = 6});
    const std::vector<std::vector<int>> legal = testing::LegalOrders(plan);

    const auto stages = StagesOf(plan, kNoLimit);

    ASSERT_TRUE(stages.has_value());
    EXPECT_EQ(OrdersOf(*stages), std::set<std::vector<int>>(legal.begin(), legal.end()));
  }
}

TEST(StagesOf, RefusesLargeStages) {
  EXPECT_FALSE(StagesOf(testing::FlatPlan(4), 3).has_value());
  EXPECT_TRUE(StagesOf(testing::FlatPlan(4), 4).has_value());
}

}  // namespace
}  // namespace traverse
