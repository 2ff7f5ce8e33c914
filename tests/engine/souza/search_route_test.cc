#include "engine/souza/search_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using namespace traverse::testing;  // NOLINT

TEST(SearchRoute, LoadsAndUnloadsARoute) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 12});
    const LayerView layer(owned.problem);
    const Route given = GivenRoute(owned.plan());

    const SearchRoute route(layer, given);

    EXPECT_EQ(route.ToRoute(), given);
    EXPECT_EQ(route.Cost(), RouteCost(owned.problem, given));
  }
}

TEST(SearchRoute, KnowsTheEndsOfTheMovesAroundAVisit) {
  OwnedProblem owned(SequentialPlan(SquareGrid(1, 1)), {-1, -1});
  const LayerView layer(owned.problem);
  const SearchRoute route(layer, GivenRoute(owned.plan()));

  EXPECT_EQ(route.from(0), (Point{-1, -1}));
  EXPECT_EQ(route.to(0), (Point{0.25, 0.5}));
  EXPECT_EQ(route.from(1), (Point{0, 0}));
  EXPECT_EQ(route.to(1), std::nullopt);
  owned.problem.finish = Point{7, 7};
  EXPECT_EQ(route.to(1), (Point{7, 7}));
}

TEST(SearchRoute, ArrangesChildrenAndRunsThemBackwards) {
  const OwnedProblem owned(AnyOrderPlan(
      {MakeContour({{0, 0}}), MakeOpenPath({1, 0}, {2, 0}), MakeOpenPath({3, 0}, {4, 0})}));
  const LayerView layer(owned.problem);
  SearchRoute route(layer, GivenRoute(owned.plan()));

  route.Arrange(0, {2, 0, 1}, {1, 1, 0});

  EXPECT_EQ(route.ToRoute(), (Route{{2, 1}, {0, 0}, {1, 0}}));
  EXPECT_THAT(route.order(0), ElementsAre(2, 0, 1));
  route.Arrange(0, {0, 1, 2}, {0, 0, 1});
  EXPECT_EQ(route.ToRoute(), GivenRoute(owned.plan()));
}

TEST(SearchRoute, WhatAChangeTouchedIsPending) {
  const OwnedProblem owned(
      AnyOrderPlan({MakeContour({{0, 0}, {1, 1}}), MakeContour({{1, 0}}), MakeContour({{2, 0}})}));
  const LayerView layer(owned.problem);
  SearchRoute route(layer, GivenRoute(owned.plan()));
  for (const int path : {0, 1, 2}) EXPECT_TRUE(route.TakePendingVisit(path));
  EXPECT_TRUE(route.TakePendingNode(0));
  EXPECT_FALSE(route.TakePendingVisit(0));

  route.SetEntry(0, 1);

  EXPECT_TRUE(route.TakePendingNode(0));
  EXPECT_TRUE(route.TakePendingVisit(1));
  EXPECT_FALSE(route.TakePendingVisit(2));
}

// Shuffles an any_order node as its precedence allows, some of its blocks backwards.
void ArrangeAtRandom(SearchRoute& route, int node, Rng& rng) {
  const PlanTree& tree = route.layer().tree;
  const auto children = tree.children(node);
  std::vector<int> ready, slots;
  std::vector<char> reversed;
  const auto note = [&](int slot) { ready.push_back(slot); };
  ReadySlots next(tree.precedence(node), static_cast<int>(children.size()), note);
  while (!ready.empty()) {
    std::swap(ready[rng.Below(static_cast<uint32_t>(ready.size()))], ready.back());
    slots.push_back(ready.back());
    ready.pop_back();
    const int child = children[static_cast<size_t>(slots.back())];
    reversed.push_back(tree.reversible(child) && rng.Below(2) == 0);
    next.Finish(slots.back(), note);
  }
  route.Arrange(node, slots, reversed);
}

TEST(SearchRoute, StaysValidAndConsistentThroughRandomChanges) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.min_paths = 1, .max_paths = 20});
    const LayerView layer(owned.problem);
    SearchRoute route(layer, GivenRoute(owned.plan()));
    Rng rng(seed);
    for (int step = 0; step < 20; ++step) {
      const int node = rng.Between(0, layer.tree.node_count() - 1);
      if (layer.tree.node(node).kind == PlanNode::Kind::kAnyOrder) {
        ArrangeAtRandom(route, node, rng);
      }
      const int position = rng.Between(0, route.size() - 1);
      const int path = layer.table.path_of(route.entry(position));
      route.SetEntry(position,
                     rng.Between(layer.table.first(path), layer.table.first(path + 1) - 1));

      ASSERT_OK(ValidateRoute(owned.plan(), route.ToRoute()));
      const SearchRoute fresh(layer, route.ToRoute());
      for (int n = 0; n < layer.tree.node_count(); ++n) {
        if (layer.tree.path_count(n) == 0) continue;
        EXPECT_EQ(route.begin(n), fresh.begin(n));
        EXPECT_TRUE(std::equal(route.order(n).begin(), route.order(n).end(), fresh.order(n).begin(),
                               fresh.order(n).end()));
      }
    }
  }
}

}  // namespace
}  // namespace traverse
