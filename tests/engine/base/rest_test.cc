// What is built whole over a layer asks its budget meanwhile: others are let on with theirs.

#include "engine/base/rest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/resting_sort.h"
#include "engine/base/rng.h"
#include "engine/cost/wall_cost.h"
#include "engine/model/tree/passed_pairs.h"
#include "engine/schedule/layer_fingerprint.h"
#include "engine/search/end_groups.h"
#include "engine/search/entries/leaf_entries.h"
#include "engine/search/order_tree.h"
#include "engine/search/search_state.h"
#include "tests/support/counting_turn.h"
#include "tests/support/problems/instances.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

Plan Dots(int n) {
  Rng rng(1);
  std::vector<Path> paths;
  for (int i = 0; i < n; ++i) paths.push_back(MakeContour({{300 * rng.Unit(), 300 * rng.Unit()}}));
  return AnyOrderPlan(std::move(paths));
}

constexpr int kMany = 200'000;
constexpr int kOften = 5;

TEST(Rest, IsTakenWhileTreesAndTablesAreBuilt) {
  const Plan plan = Dots(kMany);
  const LayerProblem problem{&plan, {}, std::nullopt, {}, 1};
  const OrderTree tree(plan);
  const LeafEntries entries(problem);
  EXPECT_GE(AsksOf([&](Budget& budget) { const OrderTree asked(plan, &budget); }), kOften);
  EXPECT_GE(AsksOf([&](Budget& budget) { const LeafEntries asked(problem, &budget); }), kOften);
  EXPECT_GE(AsksOf([&](Budget& budget) { const EndGroups asked(entries, &budget); }), kOften);
  EXPECT_GE(AsksOf([&](Budget& budget) {
              SearchState state(problem, tree, entries);
              state.Load(GivenRoute(plan), &budget);
            }),
            kOften);
}

TEST(Rest, IsTakenWithinOnePathOfManyVertices) {
  Path path = MakeContour({});
  for (int i = 0; i < kMany; ++i) path.points.push_back({0.001 * i, 0});
  const Plan plan = AnyOrderPlan({std::move(path)});
  const LayerProblem problem{&plan, {}, std::nullopt, {}, 1};
  EXPECT_GE(AsksOf([&](Budget& budget) {
              const LeafEntries entries(problem, &budget);
              const EndGroups groups(entries, &budget);
            }),
            kOften);
}

TEST(Rest, IsTakenWhileTheCostOfManyWallsIsLaidOut) {
  const Plan plan = Dots(kMany);
  LayerWalls walls;
  Wall& wall = walls.walls.emplace_back();
  for (const Path& dot : plan.paths) wall.points.push_back(dot.points[0]);
  const CostSpec spec = {CostSpec::Kind::kTime, 120, 3000, 0.05, 1};
  const auto asks = [&](const LayerWalls& laid_out, const CostSpec& by) {
    return AsksOf([&](Budget& budget) { const WallCost asked(laid_out, plan, by, &budget); });
  };
  const int of_grid = asks(walls, spec);
  EXPECT_GE(of_grid, kOften);
  CostSpec around = spec;
  around.wall_clearance_mm = 0.3;
  EXPECT_GE(asks(walls, around), of_grid + kOften);
  LayerWalls paths;
  for (int i = 0; i < kMany; ++i) paths.exposed.push_back(i);
  EXPECT_GE(asks(paths, spec), kOften);
  LayerWalls moves;
  for (int i = 1; i < kMany; ++i) moves.known.push_back({i - 1, i, 1});
  EXPECT_GE(asks(moves, spec), kOften);
  EXPECT_GE(AsksOf([&](Budget& budget) { FingerprintOf(plan, spec, walls, &budget); }), kOften);
}

TEST(Rest, IsTakenWhilePairsArePassedOn) {
  PlanNode node{PlanNode::Kind::kAnyOrder, 0, {}, {}};
  for (int i = 0; i < kMany; ++i) {
    node.children.push_back(i + 1);
    if (i > 0) node.before.emplace_back(i - 1, i);
  }
  const std::vector<bool> has_paths(static_cast<size_t>(kMany), true);
  EXPECT_GE(AsksOf([&](Budget& budget) { PassedPairs(node, has_paths, &budget); }), kOften);
}

TEST(RestingSort, SortsAsOthersDo) {
  Rng rng(7);
  for (const int size : {0, 1, 2, 4095, 4096, 4097, 20'000, 100'000}) {
    std::vector<std::pair<int, int>> values;
    for (int i = 0; i < size; ++i) values.emplace_back(static_cast<int>(rng.Below(1000)), i);
    std::vector<std::pair<int, int>> expected = values;
    std::sort(expected.begin(), expected.end());
    Rest rest(nullptr);
    RestingSort(values, rest);
    EXPECT_EQ(values, expected) << size;
  }
}

TEST(RestingSort, AsksMeanwhileAndSortsAllTheSameOnceTheBudgetHasRunOut) {
  Rng rng(8);
  std::vector<double> values;
  for (int i = 0; i < kMany; ++i) values.push_back(rng.Unit());
  CancelToken cancel;
  CountingTurn turn;
  Budget budget(&cancel, std::nullopt, &turn);
  Rest rest(&budget);
  RestingSort(values, rest, std::greater<>());
  EXPECT_GE(turn.asks, kOften);
  EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend()));

  std::reverse(values.begin(), values.end());
  cancel.Cancel();
  RestingSort(values, rest, std::greater<>());
  EXPECT_TRUE(std::is_sorted(values.rbegin(), values.rend()));
}

}  // namespace
}  // namespace traverse
