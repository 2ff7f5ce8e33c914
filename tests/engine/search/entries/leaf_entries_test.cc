#include "engine/search/entries/leaf_entries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(LeafEntries, AreTheVisitsThatThePathsAllow) {
  const OwnedProblem owned(Plan{{MakeContour({{0, 0}, {1, 0}, {1, 1}}, {2, 0}),
                                 MakeOpenPath({5, 5}, {6, 6}), MakeOpenPath({7, 7}, {8, 8}, true)},
                                {}});

  const LeafEntries entries(owned.problem);

  EXPECT_EQ(entries.leaf_count(), 5);
  EXPECT_EQ(entries.count(0), 2);
  EXPECT_EQ(entries.VisitOf(0, entries.first(0)), (Visit{0, 2}));
  EXPECT_EQ(entries.EntryOf(Visit{0, 0}), entries.first(0) + 1);
  EXPECT_EQ(entries.exit(entries.EntryOf(Visit{1, 1})), (Point{5, 5}));
  EXPECT_EQ(entries.Reversed(1, entries.EntryOf(Visit{1, 1})), entries.EntryOf(Visit{1, 0}));
  EXPECT_EQ(entries.count(2), 1);
  EXPECT_EQ(entries.enter(entries.first(3)), owned.problem.start);
}

TEST(LeafEntries, BestCostsNoMoreThanAnyOtherEntry) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.min_paths = 3, .max_vertices = 150});
    const LeafEntries entries(owned.problem);
    const TravelCost cost(owned.problem.cost);
    Rng rng(seed);
    std::vector<float> tails;
    for (int leaf = 0; leaf < entries.leaf_count(); ++leaf) {
      const Point from{rng.Unit() * 100, rng.Unit() * 100};
      const Point next{rng.Unit() * 100, rng.Unit() * 100};
      for (const Point* to : {&next, static_cast<const Point*>(nullptr)}) {
        const auto total = [&](int e) {
          return cost(from, entries.enter(e)) + (to != nullptr ? cost(entries.exit(e), *to) : 0);
        };
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < entries.count(leaf); ++i) {
          least = std::min(least, total(entries.first(leaf) + i));
        }

        const int best = entries.Best(leaf, from, to, cost);

        EXPECT_GE(best, entries.first(leaf));
        EXPECT_LT(best, entries.first(leaf) + entries.count(leaf));
        EXPECT_NEAR(total(best), least, 1e-4 * (1 + least));
        if (entries.open(leaf)) continue;

        entries.FillTails(leaf, to, tails);
        const int with_tails = entries.BestWithTails(leaf, from, tails);

        EXPECT_LT(with_tails, entries.first(leaf) + entries.count(leaf));
        EXPECT_NEAR(total(with_tails), least, 1e-4 * (1 + least));
      }
    }
  }
}

TEST(LeafEntries, BoundsOfPairsAreNoMoreThanTheBestPairCosts) {
  int tight = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(
        seed,
        {.shape = PlanShape::kFlatContours, .min_paths = 2, .max_paths = 2, .max_vertices = 60});
    const LeafEntries entries(owned.problem);
    if (entries.count(0) == 1 || entries.count(1) == 1) continue;
    const TravelCost cost(owned.problem.cost);
    Rng rng(seed);
    const Point from{rng.Unit() * 100, rng.Unit() * 100};
    const Point next{rng.Unit() * 100, rng.Unit() * 100};
    std::vector<float> tails;
    std::vector<float> bounds;
    for (const Point* to : {&next, static_cast<const Point*>(nullptr)}) {
      entries.FillTails(1, to, tails);

      entries.FillPairBounds(0, 1, from, to, tails, bounds);

      for (int i = 0; i < entries.count(0); ++i) {
        const Point a = entries.enter(entries.first(0) + i);
        double least = std::numeric_limits<double>::infinity();
        for (int j = 0; j < entries.count(1); ++j) {
          const Point b = entries.enter(entries.first(1) + j);
          least = std::min(least, cost(from, a) + cost(a, b) + (to != nullptr ? cost(b, *to) : 0));
        }
        const auto bound = static_cast<double>(bounds[static_cast<size_t>(i)]);
        ASSERT_LE(bound, least + 1e-4 * (1 + least));
        tight += bound > 0.7 * least;
      }
    }
  }
  EXPECT_GT(tight, 1000);
}

}  // namespace
}  // namespace traverse
