#include "engine/model/tree/compiled_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/model/tree/passed_pairs.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;
using namespace traverse::testing;  // NOLINT

// any_order over a node without paths, path 0, another such node, and paths 1 and 2.
Plan WithPathlessChildren(std::vector<std::pair<int, int>> before) {
  Plan plan = FlatPlan(3);
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kInOrder, 0, {}, {}});
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kAnyOrder, 0, {}, {}});
  plan.nodes[0].children = {4, 1, 5, 2, 3};
  plan.nodes[0].before = std::move(before);
  return plan;
}

TEST(CompiledPlan, LeavesOutChildrenWithoutPaths) {
  const Plan plan = WithPathlessChildren({});
  const CompiledPlan compiled(plan);

  EXPECT_THAT(compiled.children(0), ElementsAre(1, 2, 3));
  EXPECT_THAT(compiled.children(4), IsEmpty());
  EXPECT_EQ(compiled.path_count(0), 3);
  EXPECT_EQ(compiled.path_count(5), 0);
  EXPECT_EQ(compiled.parent(5), 0);
  EXPECT_EQ(compiled.parent(0), -1);
}

TEST(CompiledPlan, CountsThePathsOfItsChildrenAndKnowsTheLeaves) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = RandomPlan(seed, {.max_paths = 12});
    const CompiledPlan compiled(plan);

    for (size_t path = 0; path < plan.paths.size(); ++path) {
      const int leaf = compiled.leaf(static_cast<int>(path));
      ASSERT_TRUE(compiled.is_leaf(leaf));
      EXPECT_EQ(compiled.node(leaf).path, static_cast<int>(path));
    }
    int listed = 0;
    for (int node = 0; node < compiled.node_count(); ++node) {
      EXPECT_EQ(compiled.first_child(node), listed);
      listed += static_cast<int>(compiled.children(node).size());
      int below = compiled.is_leaf(node) ? 1 : 0;
      for (const int child : compiled.children(node)) {
        EXPECT_EQ(compiled.parent(child), node);
        EXPECT_GT(compiled.path_count(child), 0);
        below += compiled.path_count(child);
      }
      EXPECT_EQ(compiled.path_count(node), below);
    }
    EXPECT_EQ(compiled.first_child(compiled.node_count()), listed);
  }
}

TEST(CompiledPlan, PairsOfSlotsGoThroughChildrenWithoutPaths) {
  // Child 1, path 0, comes before child 2, without paths, and that before child 4, path 2.
  const Plan plan = WithPathlessChildren({{1, 2}, {2, 4}, {0, 1}, {4, 3}});

  EXPECT_THAT(CompiledPlan(plan).SlotPairs(0),
              Optional(UnorderedElementsAre(Pair(0, 2), Pair(2, 1))));
}

TEST(CompiledPlan, PairsOfSlotsAreThoseOfTheChildrenWhereAllHavePaths) {
  Plan plan = FlatPlan(4);
  plan.nodes[0].before = {{0, 1}, {2, 1}, {0, 3}};

  EXPECT_THAT(CompiledPlan(plan).SlotPairs(0),
              Optional(UnorderedElementsAre(Pair(0, 1), Pair(2, 1), Pair(0, 3))));
  plan.nodes[0].before.clear();
  EXPECT_THAT(CompiledPlan(plan).SlotPairs(0), Optional(IsEmpty()));
}

// k paths before a node without any before k others are k^2 pairs.
TEST(CompiledPlan, PairsThatAreTooManyAreNone) {
  const int k = 2000;
  Plan plan = FlatPlan(2 * k);
  const int barrier = static_cast<int>(plan.nodes.size());
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kInOrder, 0, {}, {}});
  plan.nodes[0].children.push_back(barrier);
  for (int i = 0; i < k; ++i) {
    plan.nodes[0].before.emplace_back(i, 2 * k);
    plan.nodes[0].before.emplace_back(2 * k, k + i);
  }

  EXPECT_EQ(CompiledPlan(plan).SlotPairs(0), std::nullopt);
}

}  // namespace
}  // namespace traverse
