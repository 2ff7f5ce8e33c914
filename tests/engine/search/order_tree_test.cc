#include "engine/search/order_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/problems/instances.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT
using ::testing::ElementsAre;
using ::testing::IsEmpty;

PlanNode Leaf(int path) { return PlanNode{PlanNode::Kind::kPath, path, {}, {}}; }
PlanNode AnyOrder(std::vector<int> children, std::vector<std::pair<int, int>> before = {}) {
  return PlanNode{PlanNode::Kind::kAnyOrder, 0, std::move(children), std::move(before)};
}
PlanNode InOrder(std::vector<int> children) {
  return PlanNode{PlanNode::Kind::kInOrder, 0, std::move(children), {}};
}

std::vector<Path> Dots(int count) { return FlatPlan(count).paths; }

TEST(OrderTree, PutsStartAndFinishAroundThePlan) {
  const OrderTree tree(FlatPlan(3));

  EXPECT_EQ(tree.path_count(), 3);
  EXPECT_EQ(tree.parent(tree.start()), tree.root());
  EXPECT_EQ(tree.parent(tree.finish()), tree.root());
  EXPECT_EQ(tree.size(tree.root()), 5);
  EXPECT_FALSE(tree.free_order(tree.root()));
  EXPECT_TRUE(tree.free_order(tree.parent(0)));
  EXPECT_FALSE(tree.nested());
}

TEST(OrderTree, OfAnEmptyPlanHasNoChoice) {
  const OrderTree tree{Plan{}};

  EXPECT_EQ(tree.path_count(), 0);
  EXPECT_FALSE(tree.has_choice());
}

TEST(OrderTree, ReplacesNodesOfOneChildByTheChild) {
  const Plan plan{Dots(2), {InOrder({1}), AnyOrder({2, 3}), InOrder({4}), Leaf(1), Leaf(0)}};

  const OrderTree tree(plan);

  EXPECT_EQ(tree.parent(0), tree.parent(1));
  EXPECT_EQ(tree.depth(0), 2);
  EXPECT_THAT(tree.children(tree.parent(0)), ElementsAre(0, 1));
}

TEST(OrderTree, PassesPairsOnThroughNodesWithoutPaths) {
  const Plan plan{Dots(2),
                  {AnyOrder({1, 2, 3, 4}, {{3, 1}, {1, 2}, {2, 0}}), Leaf(0), InOrder({}),
                   AnyOrder({}), Leaf(1)}};

  const OrderTree tree(plan);

  EXPECT_THAT(tree.after(1), ElementsAre(0));
  EXPECT_THAT(tree.before(0), ElementsAre(1));
  EXPECT_THAT(tree.after(0), IsEmpty());
  EXPECT_TRUE(tree.has_pairs(tree.parent(0)));
}

// `k` leaves before an empty node, and that before as many others.
Plan Barrier(int k) {
  Plan plan{Dots(2 * k), {AnyOrder({})}};
  for (int child = 0; child <= 2 * k; ++child) {
    plan.nodes[0].children.push_back(child + 1);
    if (child == k) {
      plan.nodes.push_back(InOrder({}));
      continue;
    }
    plan.nodes.push_back(Leaf(child < k ? child : child - 1));
    plan.nodes[0].before.push_back(child < k ? std::pair(child, k) : std::pair(k, child));
  }
  return plan;
}

TEST(OrderTree, PassesOnNoMorePairsThanThePlanIsLarge) {
  constexpr int k = 2000;
  const OrderTree tree(Barrier(k));

  size_t pairs = 0;
  for (int item = 0; item < tree.item_count(); ++item) pairs += tree.after(item).size();

  EXPECT_LT(pairs, size_t{k} * k / 10);
  EXPECT_FALSE(tree.free_order(tree.parent(0))) << "without the pairs nothing may change place";
  EXPECT_TRUE(tree.has_choice()) << "there is one, if it is not taken";
  const OrderTree small(Barrier(20));
  EXPECT_TRUE(small.free_order(small.parent(0)));
  EXPECT_EQ(small.after(0).size(), 20u);
}

TEST(OrderTree, KnowsWhatCanBeDoneBackwards) {
  Plan plan{
      Dots(4),
      {AnyOrder({1, 2}), AnyOrder({3, 4}), InOrder({5, 6}), Leaf(0), Leaf(1), Leaf(2), Leaf(3)}};
  {
    const OrderTree tree(plan);
    EXPECT_TRUE(tree.reversible(tree.parent(0)));
    EXPECT_FALSE(tree.reversible(tree.parent(2)));
    EXPECT_FALSE(tree.children_reversible(tree.CommonNode(0, 2)));
    EXPECT_TRUE(tree.nested());
  }
  plan.paths[1] = MakeOpenPath({0, 0}, {1, 1}, true);
  const OrderTree tree(plan);
  EXPECT_FALSE(tree.reversible(1));
  EXPECT_FALSE(tree.reversible(tree.parent(0)));
}

TEST(OrderTree, FindsTheDeepestCommonNode) {
  const Plan plan{
      Dots(4),
      {AnyOrder({1, 2}), AnyOrder({3, 4}), InOrder({5, 6}), Leaf(0), Leaf(1), Leaf(2), Leaf(3)}};

  const OrderTree tree(plan);

  EXPECT_EQ(tree.CommonNode(0, 1), tree.parent(0));
  EXPECT_EQ(tree.CommonNode(1, 2), tree.parent(tree.parent(0)));
  EXPECT_EQ(tree.CommonNode(0, tree.finish()), tree.root());
  EXPECT_EQ(tree.ChildHolding(tree.CommonNode(1, 2), 3), tree.parent(2));
}

}  // namespace
}  // namespace traverse
