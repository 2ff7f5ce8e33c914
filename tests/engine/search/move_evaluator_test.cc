#include "engine/search/move_evaluator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "engine/validator.h"
#include "tests/engine/search/searched.h"
#include "tests/support/problems/instances.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// Calls `check` with random moves that random plans allow: search, evaluator, move, random numbers.
template <typename Check>
void ForRandomMoves(uint64_t seeds, const Check& check) {
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 3, .max_paths = 20});
    MoveEvaluator evaluator(s.state);
    Rng rng(seed);
    for (int i = 0; i < 30; ++i) {
      const SegmentMove move = RandomMove(rng, s.tree.path_count());
      if (!s.state.Allows(move)) continue;
      ASSERT_NO_FATAL_FAILURE(check(s, evaluator, move, rng));
    }
  }
}

TEST(MoveEvaluator, DeltaEqualsRecomputedCost) {
  ForRandomMoves(300, [](Searched& s, MoveEvaluator& evaluator, const SegmentMove& move, Rng&) {
    const double before = s.state.TotalCost();

    const double delta = evaluator.Evaluate(move);
    evaluator.Apply(move);

    ASSERT_NEAR(s.state.TotalCost(), before + delta, kCostTolerance);
    ASSERT_OK(ValidateRoute(s.owned.plan(), s.state.Unload()));
  });
}

TEST(MoveEvaluator, EndsEarlyForMovesThatCostTooMuchAlone) {
  int ended = 0;
  ForRandomMoves(100, [&](Searched&, MoveEvaluator& evaluator, const SegmentMove& move, Rng& rng) {
    const double delta = evaluator.Evaluate(move);
    const double most = 100 * (rng.Unit() - 0.5);

    const double limited = evaluator.Evaluate(move, most);

    if (delta < most) {
      ASSERT_EQ(limited, delta);
    } else {
      ASSERT_GE(limited, most);
      ended += limited < delta;
    }
  });
  EXPECT_GT(ended, 100);
}

// `most` is above the change by less than costs are rounded by.
TEST(MoveEvaluator, WhatCostsLessThanTheMostByRoundingAloneMayBeDone) {
  ForRandomMoves(300, [](Searched& s, MoveEvaluator& evaluator, const SegmentMove& move, Rng& rng) {
    const double before = s.state.TotalCost();
    const double delta = evaluator.Evaluate(move);
    const double ulp = std::nextafter(before, 2 * before) - before;
    const double most = delta + rng.Unit() * ulp;

    const double limited = evaluator.Evaluate(move, most);

    if (limited >= most) return;
    evaluator.Apply(move);
    ASSERT_NEAR(s.state.TotalCost(), before + limited, kCostTolerance);
  });
}

// Two contours change places: with the entries that suited the old neighbors, which face away from
// the new ones, the move would seem to cost 16 mm.
TEST(MoveEvaluator, ChoosesEntriesForTheNewNeighbors) {
  const auto contour = [](double x) { return MakeContour({{x - 2, 0}, {x + 2, 0}}); };
  const OwnedProblem owned(AnyOrderPlan({contour(20), contour(10), contour(30)}));
  const OrderTree tree(owned.plan());
  const LeafEntries entries(owned.problem);
  SearchState state(owned.problem, tree, entries);
  state.Load({{0, 0}, {1, 1}, {2, 0}});
  MoveEvaluator evaluator(state);

  const double delta = evaluator.Evaluate({SegmentMove::Kind::kReverse, 1, 1, 2});

  EXPECT_NEAR(state.TotalCost(), 18 + 6 + 16, 1e-9);
  EXPECT_NEAR(delta, 28 - 40, 1e-9);
}

// The middle one of three: both its entries are as far from the one before, and one is nearer to
// the one behind.
TEST(MoveEvaluator, ChoosesEntriesWithTheNextNeighborInView) {
  const OwnedProblem owned(AnyOrderPlan(
      {MakeContour({{20, 5}, {20, -5}}), MakeContour({{10, 0}}), MakeContour({{30, -5}})}));
  const OrderTree tree(owned.plan());
  const LeafEntries entries(owned.problem);
  SearchState state(owned.problem, tree, entries);
  state.Load({{0, 0}, {1, 0}, {2, 0}});
  MoveEvaluator evaluator(state);
  const double before = state.TotalCost();

  const SegmentMove move{SegmentMove::Kind::kReverse, 1, 1, 2};
  const double delta = evaluator.Evaluate(move);
  evaluator.Apply(move);

  EXPECT_EQ(state.Unload(), (Route{{1, 0}, {0, 1}, {2, 0}}));
  EXPECT_NEAR(before + delta, 10 + std::sqrt(125) + 10, 1e-9);
}

}  // namespace
}  // namespace traverse
