#include "engine/model/tree/plan_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/validator.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using namespace traverse::testing;  // NOLINT

// any_order over paths 0, 1, 2 and, as child 3, a node without paths.
Plan WithPathlessChild(std::vector<std::pair<int, int>> before) {
  Plan plan = FlatPlan(3);
  plan.nodes.push_back(PlanNode{PlanNode::Kind::kInOrder, 0, {}, {}});
  plan.nodes[0].children = {1, 4, 2, 3};
  plan.nodes[0].before = std::move(before);
  return plan;
}

TEST(PlanTree, CountsPathsAndSkipsChildrenWithoutAny) {
  const Plan plan = WithPathlessChild({});

  const PlanTree tree(plan);

  EXPECT_EQ(tree.path_count(0), 3);
  EXPECT_EQ(tree.path_count(4), 0);
  EXPECT_THAT(tree.children(0), ElementsAre(1, 2, 3));
  EXPECT_EQ(tree.parent(3), 0);
  EXPECT_EQ(tree.parent(0), -1);
  EXPECT_TRUE(tree.precedence(0).empty());
}

TEST(PlanTree, ReversesOnlyWhatHasNoOrderOfItsOwn) {
  const Plan sequential = SequentialPlan(PlateWithHoles());
  const PlanTree tree(sequential);
  EXPECT_FALSE(tree.reversible(0));
  EXPECT_TRUE(tree.reversible(1));

  Plan one_way = AnyOrderPlan({MakeContour({{0, 0}}), MakeOpenPath({1, 1}, {2, 2}, true)});
  EXPECT_FALSE(PlanTree(one_way).reversible(0));
  one_way.paths[1].one_way = false;
  EXPECT_TRUE(PlanTree(one_way).reversible(0));
  one_way.nodes[0].before = {{0, 1}};
  EXPECT_FALSE(PlanTree(one_way).reversible(0));
}

TEST(PlanTree, ReversedRoutesOfReversibleNodesAreLegal) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = RandomPlan(seed, {.max_paths = 6});
    if (plan.nodes.empty() || !PlanTree(plan).reversible(0)) continue;

    Route route = GivenRoute(plan);
    std::reverse(route.begin(), route.end());
    for (Visit& visit : route) {
      if (plan.paths[static_cast<size_t>(visit.path)].kind == Path::Kind::kOpen) visit.entry ^= 1;
    }
    EXPECT_TRUE(ValidateRoute(plan, route).ok());
  }
}

TEST(Precedence, LooksThroughChildrenWithoutPaths) {
  const Plan plan = WithPathlessChild({{3, 1}, {1, 0}, {2, 3}});
  const PlanTree tree(plan);
  std::vector<int> last;

  tree.precedence(0).LastBefore({2, 1, 0}, last);

  EXPECT_EQ(last[0], 0);
  EXPECT_EQ(last[1], -1);
  EXPECT_EQ(last[2], 1);
}

TEST(Precedence, ADirectTestOfTheLastBeforeDecidesWhetherAnOrderIsLegal) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = RandomPlan(seed, {.shape = PlanShape::kFlatBefore, .max_paths = 6});
    const PlanTree tree(plan);
    if (tree.precedence(0).empty()) continue;
    std::vector<std::vector<int>> legal = LegalOrders(plan);
    std::sort(legal.begin(), legal.end());
    std::vector<int> order(plan.paths.size()), position(order.size()), last;
    for (size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    do {
      for (size_t i = 0; i < order.size(); ++i) {
        position[static_cast<size_t>(order[i])] = static_cast<int>(i);
      }

      tree.precedence(0).LastBefore(position, last);

      const bool kept = std::equal(position.begin(), position.end(), last.begin(),
                                   [](int own, int before) { return before < own; });
      EXPECT_EQ(kept, std::binary_search(legal.begin(), legal.end(), order));
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(ReadySlots, ReportsEachSlotWhenTheLastThatItWaitsForIsDone) {
  const Plan plan = WithPathlessChild({{0, 1}, {2, 1}, {1, 3}});
  const PlanTree tree(plan);
  std::vector<int> ready;
  const auto note = [&](int slot) { ready.push_back(slot); };

  ReadySlots slots(tree.precedence(0), 3, note);
  EXPECT_THAT(ready, ElementsAre(0, 1));
  ready.clear();
  slots.Finish(1, note);
  EXPECT_THAT(ready, IsEmpty());
  slots.Finish(0, note);
  EXPECT_THAT(ready, ElementsAre(2));
}

}  // namespace
}  // namespace traverse
