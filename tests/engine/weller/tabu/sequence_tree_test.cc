#include "engine/weller/tabu/sequence_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/model/route.h"
#include "engine/validator.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

PlanNode Leaf(int path) { return PlanNode{PlanNode::Kind::kPath, path, {}, {}}; }

// any_order(path 0, in_order(path 1, any_order()), any_order(path 2, path 3)), the last child
// before the first one by way of the second.
Plan Nested() {
  Plan plan = testing::FlatPlan(4);
  plan.nodes = {PlanNode{PlanNode::Kind::kAnyOrder, 0, {1, 2, 3}, {{2, 1}, {1, 0}}},
                Leaf(0),
                PlanNode{PlanNode::Kind::kInOrder, 0, {4, 5}, {}},
                PlanNode{PlanNode::Kind::kAnyOrder, 0, {6, 7}, {}},
                Leaf(1),
                PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}},
                Leaf(2),
                Leaf(3)};
  return plan;
}

TEST(SequenceTree, KnowsWhereTheChildrenAre) {
  SequenceTree tree(Nested());

  EXPECT_THAT(tree.Paths(), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(tree.movable_nodes().size(), 2u);
  EXPECT_EQ(tree.violations(), 2);

  tree.Swap(0, 0, 2);

  EXPECT_THAT(tree.Paths(), ElementsAre(2, 3, 1, 0));
  EXPECT_EQ(tree.violations(), 0);
  EXPECT_EQ(tree.begin(tree.child_at(0, 0)), 0);
  EXPECT_EQ(tree.end(tree.child_at(0, 0)), 2);
  EXPECT_EQ(tree.begin(tree.child_at(0, 2)), 3);
}

TEST(SequenceTree, PairsPassThroughChildrenWithoutPaths) {
  Plan plan = testing::FlatPlan(2);
  plan.nodes = {PlanNode{PlanNode::Kind::kAnyOrder, 0, {1, 2, 3}, {{2, 1}, {1, 0}}}, Leaf(0),
                PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}}, Leaf(1)};

  SequenceTree tree(plan);

  EXPECT_EQ(tree.violations(), 1);
  EXPECT_EQ(tree.ViolationDelta(0, 0, 1), -1);
}

// `k` leaves before an empty node, and that before as many others.
Plan Barrier(int k) {
  Plan plan = testing::FlatPlan(2 * k);
  plan.nodes = {PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}}};
  for (int child = 0; child <= 2 * k; ++child) {
    plan.nodes[0].children.push_back(child + 1);
    if (child == k) {
      plan.nodes.push_back(PlanNode{PlanNode::Kind::kInOrder, 0, {}, {}});
      continue;
    }
    plan.nodes.push_back(Leaf(child < k ? child : child - 1));
    plan.nodes[0].before.push_back(child < k ? std::pair(child, k) : std::pair(k, child));
  }
  return plan;
}

TEST(SequenceTree, PassesOnNoMorePairsThanThePlanIsLarge) {
  constexpr int k = 2000;
  const Plan plan = Barrier(k);
  SequenceTree tree(plan);
  std::vector<int> paths;
  for (int p = 0; p < k; ++p) paths.push_back(k - 1 - p);
  for (int p = 0; p < k; ++p) paths.push_back(k + p);

  tree.Load(paths);
  Rng rng(1);
  tree.Shuffle(rng);

  size_t pairs = 0;
  for (int node = 0; node < tree.node_count(); ++node) pairs += size_t(tree.pair_count(node));
  EXPECT_LT(pairs, size_t{k} * k / 10);
  EXPECT_THAT(tree.movable_nodes(), IsEmpty());
  EXPECT_EQ(tree.Paths(), paths) << "it stays as it was loaded";
  EXPECT_EQ(SequenceTree(Barrier(20)).movable_nodes().size(), 1u);
}

TEST(SequenceTree, OfAnEmptyPlan) { EXPECT_THAT(SequenceTree(Plan{}).Paths(), IsEmpty()); }

int CountViolations(const SequenceTree& tree, const Plan& plan) {
  SequenceTree anew(plan);
  anew.Load(tree.Paths());
  return anew.violations();
}

TEST(SequenceTree, StaysConsistentThroughSwaps) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = testing::RandomPlan(seed, {.max_paths = 12});
    SequenceTree tree(plan);
    if (tree.movable_nodes().empty()) continue;
    Rng rng(seed);
    for (int step = 0; step < 20; ++step) {
      const auto& nodes = tree.movable_nodes();
      const int node = nodes[rng.Below(uint32_t(nodes.size()))];
      const int i = rng.Between(0, tree.child_count(node) - 2);
      const int j = rng.Between(i + 1, tree.child_count(node) - 1);
      const int predicted = tree.violations() + tree.ViolationDelta(node, i, j);

      tree.Swap(node, i, j);

      EXPECT_EQ(tree.violations(), predicted);
      EXPECT_EQ(tree.violations(), CountViolations(tree, plan));
      Route route;
      for (const int path : tree.Paths()) {
        route.push_back({path, GivenEntry(plan.paths[size_t(path)])});
      }
      EXPECT_EQ(tree.violations() == 0, ValidateRoute(plan, route).ok());
    }
  }
}

TEST(SequenceTree, ShufflesKeepAllPairs) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = testing::RandomPlan(seed, {.max_paths = 12});
    SequenceTree tree(plan);
    Rng rng(seed);

    tree.Shuffle(rng);

    EXPECT_EQ(tree.violations(), 0);
    EXPECT_EQ(CountViolations(tree, plan), 0);
  }
}

}  // namespace
}  // namespace traverse
