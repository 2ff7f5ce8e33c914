#include "engine/search/local_search.h"

#include <gtest/gtest.h>

#include <chrono>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/problems/instances.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(LocalSearch, ReturnsTheChangeOfCostAndNeverMakesItWorse) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 1, .max_paths = 40, .max_vertices = 20});
    const double before = s.state.TotalCost();
    LocalSearch search(s.state, s.neighbors, LocalSearchOptions{{}, 3});
    search.PushAll();

    const double delta = search.Run(s.budget);

    EXPECT_LE(delta, 0);
    EXPECT_NEAR(s.state.TotalCost(), before + delta, kCostTolerance * (1 + before));
    EXPECT_OK(ValidateRoute(s.owned.plan(), s.state.Unload()));
  }
}

// Twenty points in a row and four far away, which are visited in a bad order. A part of the row is
// turned.
TEST(LocalSearch, EndsWhereItHasUndoneAChange) {
  std::vector<Path> paths;
  for (int i = 0; i < 20; ++i) paths.push_back(MakeContour({{1.0 * i, 0.1 * (i % 3)}}));
  for (const double x : {1000, 1002, 1001, 1003}) paths.push_back(MakeContour({{x, 0}}));
  Searched s{OwnedProblem(AnyOrderPlan(std::move(paths)))};
  const Route before = s.state.Unload();
  const double cost = s.state.TotalCost();
  s.state.Apply({SegmentMove::Kind::kReverse, 5, 5, 12});
  const double owed = s.state.TotalCost() - cost;
  LocalSearch search(s.state, s.neighbors, {});
  for (const int leaf : {s.state.leaf_at(5), s.state.leaf_at(12)}) search.Push(leaf);
  search.PushAll();

  EXPECT_NEAR(search.Run(s.budget, owed), -owed, kImprovementTolerance);
  EXPECT_EQ(s.state.Unload(), before);

  search.PushAll();
  EXPECT_LT(search.Run(s.budget), -1);
}

// The two moves that change here lead to the bad ones, so those need no search of their own.
TEST(LocalSearch, SearchesFromTheMovesThatChanged) {
  std::vector<Path> paths;
  for (int i = 0; i < 20; ++i) paths.push_back(MakeContour({{1.0 * i, 0.1 * (i % 3)}}));
  Searched s{OwnedProblem(AnyOrderPlan(std::move(paths)))};
  const double cost = s.state.TotalCost();
  s.state.Apply({SegmentMove::Kind::kReverse, 5, 5, 12});
  const double owed = s.state.TotalCost() - cost;
  LocalSearch search(s.state, s.neighbors, {.three_opt = {}, .both_edges = false});

  EXPECT_EQ(search.Run(s.budget), 0);
  search.PushMove(8);  // as it was before, the other way round
  EXPECT_EQ(search.Run(s.budget), 0);
  for (const int position : {4, 12}) search.PushMove(position);
  EXPECT_NEAR(search.Run(s.budget), -owed, kImprovementTolerance);
}

TEST(LocalSearch, LeavesTheRouteAloneAfterTheDeadline) {
  Searched s(5, {.min_paths = 20, .max_paths = 20});
  const Route before = s.state.Unload();
  Budget late(nullptr, Budget::Clock::now() - std::chrono::seconds(1));
  LocalSearch search(s.state, s.neighbors, {});
  search.PushAll();

  EXPECT_EQ(search.Run(late), 0);
  EXPECT_EQ(s.state.Unload(), before);
}

TEST(LocalSearch, ChoosesTheEntriesOfTwoVisitsExactly) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 4, .max_paths = 4, .max_vertices = 30});
    LocalSearch search(s.state, s.neighbors, {});
    const double before = s.state.TotalCost();
    const int a = s.state.leaf_at(2);
    const int b = s.state.leaf_at(3);
    double least = before;
    const size_t mark = s.state.Mark();
    for (int i = 0; i < s.entries.count(a); ++i) {
      for (int j = 0; j < s.entries.count(b); ++j) {
        s.state.SetEntry(a, s.entries.first(a) + i);
        s.state.SetEntry(b, s.entries.first(b) + j);
        least = std::min(least, s.state.TotalCost());
      }
    }
    s.state.UndoTo(mark);

    const double delta = search.ChooseEntries(2, 3);

    EXPECT_NEAR(before + delta, least, 1e-4);
    EXPECT_NEAR(s.state.TotalCost(), before + delta, kCostTolerance);
  }
}

}  // namespace
}  // namespace traverse
