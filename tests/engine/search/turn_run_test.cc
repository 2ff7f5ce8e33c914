#include "engine/search/turn_run.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/owned_problem.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

int LastPosition(const Searched& s, int node) {
  return s.state.position(node) + s.tree.size(node) - 1;
}

TEST(TurnRun, GivesValidRoutesAndCanBeUndone) {
  int turned = 0;
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 3, .max_paths = 30});
    const Route before = s.state.Unload();
    for (int node = s.tree.root(); node < s.tree.item_count(); ++node) {
      if (!TurnsOnly(s.tree, node)) continue;
      const size_t mark = s.state.Mark();

      TurnRun(s.state, node, s.state.position(node), LastPosition(s, node));

      EXPECT_OK(ValidateRoute(s.owned.plan(), s.state.Unload()));
      EXPECT_NEAR(s.state.TotalCost(), RouteCost(s.owned.problem, s.state.Unload()), 1e-9);
      turned += s.state.Unload() != before;
      s.state.UndoTo(mark);
      EXPECT_EQ(s.state.Unload(), before);
    }
  }
  EXPECT_GT(turned, 200);
}

TEST(TurnRun, TwiceIsTheIdentityWithoutPairs) {
  int runs = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.shape = PlanShape::kInterleaved, .min_paths = 6, .max_paths = 30});
    const Route before = s.state.Unload();
    for (int node = s.tree.root(); node < s.tree.item_count(); ++node) {
      if (!TurnsOnly(s.tree, node) || s.tree.has_pairs(node)) continue;
      TurnRun(s.state, node, s.state.position(node), LastPosition(s, node));
      TurnRun(s.state, node, s.state.position(node), LastPosition(s, node));
      EXPECT_EQ(s.state.Unload(), before);
      ++runs;
    }
  }
  EXPECT_GT(runs, 20);
}

// Blocks are in the opposite order, the rasters within them too and reversed, contours still first.
TEST(TurnRun, TurnsBlocksAsFarAsTheyCanBe) {
  std::vector<IslandPaths> islands = SquareGrid(3, 1);
  for (IslandPaths& island : islands) island.rasters.push_back(island.rasters[0]);
  const OwnedProblem owned(InterleavedPlan(std::move(islands)));
  const OrderTree tree(owned.plan());
  const LeafEntries entries(owned.problem);
  SearchState state(owned.problem, tree, entries);
  state.Load(GivenRoute(owned.plan()));
  const int node = tree.parent(tree.parent(0));
  ASSERT_TRUE(TurnsOnly(tree, node));

  TurnRun(state, node, 1, 9);

  const Route turned = {{6, 0}, {8, 1}, {7, 1}, {3, 0}, {5, 1}, {4, 1}, {0, 0}, {2, 1}, {1, 1}};
  EXPECT_EQ(state.Unload(), turned);
}

TEST(TurnRun, KeepsPairs) {
  Plan plan = FlatPlan(4);
  plan.nodes[0].before = {{0, 3}, {1, 2}};
  const OwnedProblem owned(std::move(plan));
  const OrderTree tree(owned.plan());
  const LeafEntries entries(owned.problem);
  SearchState state(owned.problem, tree, entries);
  state.Load(GivenRoute(owned.plan()));

  TurnRun(state, tree.parent(0), 1, 4);

  // 3 and 2 have to wait for 0 and 1.
  EXPECT_EQ(state.Unload(), (Route{{1, 0}, {2, 0}, {0, 0}, {3, 0}}));
}

}  // namespace
}  // namespace traverse
