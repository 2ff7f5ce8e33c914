#include "engine/search/three_opt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "tests/engine/search/searched.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

// Deltas add up to decide whether several moves are a gain: what is off by more than
// kImprovementTolerance makes gains of nothing, for ever.
constexpr double kExact = kImprovementTolerance / 100;

ThreeOptOptions Wide() {
  ThreeOptOptions options;
  options.second_breadth = 12;
  options.keep = 100;
  return options;
}

TEST(ThreeOpt, DeltasAreThoseOfTheMovesWithTheEntriesAsTheyAre) {
  int moves = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed);
    const double before = s.state.TotalCost();
    ThreeOpt search(s.state, s.neighbors, Wide());
    for (int leaf = 0; leaf < s.tree.path_count(); ++leaf) {
      for (const bool forward : {true, false}) {
        search.Search(leaf, forward, 0);

        for (const ThreeOpt::Found& found : search.found()) {
          ++moves;
          ASSERT_TRUE(s.state.Allows(found.move));
          s.state.Apply(found.move);
          ASSERT_NEAR(s.state.TotalCost(), before + found.delta, kExact * (1 + before));
          s.state.UndoTo(0);
        }
        if (search.open().t2 < 0) continue;
        ASSERT_TRUE(s.state.Allows(search.open().move));
        s.state.Apply(search.open().move);
        ASSERT_NEAR(s.state.TotalCost(), before + search.open().delta, kExact * (1 + before));
        const int apart = s.state.position(leaf) - s.state.position(search.open().t2);
        ASSERT_EQ(std::abs(apart), 1);
        s.state.UndoTo(0);
      }
    }
  }
  EXPECT_GT(moves, 1000);
}

TEST(ThreeOpt, FindsTheSameWithoutAnOpenMove) {
  int moves = 0;
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.min_paths = 12, .max_paths = 30});
    ThreeOpt with(s.state, s.neighbors, {});
    ThreeOpt without(s.state, s.neighbors, {});
    for (int leaf = 0; leaf < s.tree.path_count(); ++leaf) {
      with.Search(leaf, true, 0);

      without.Search(leaf, true, 0, false);

      EXPECT_EQ(without.open().t2, -1);
      ASSERT_EQ(without.found().size(), with.found().size());
      for (size_t k = 0; k < with.found().size(); ++k, ++moves) {
        ASSERT_EQ(without.found()[k].delta, with.found()[k].delta);
      }
    }
  }
  EXPECT_GT(moves, 1000);
}

TEST(ThreeOpt, CountsTheDebt) {
  int found = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(seed, {.shape = PlanShape::kFlatContours, .min_paths = 12, .max_paths = 12});
    ThreeOpt search(s.state, s.neighbors, Wide());
    search.Search(0, true, 0);
    const std::vector<ThreeOpt::Found> moves(search.found().begin(), search.found().end());

    search.Search(0, true, 1e-3);

    for (size_t k = 0; k < std::min<size_t>(5, search.found().size()); ++k, ++found) {
      EXPECT_NEAR(search.found()[k].delta, moves[k].delta + 1e-3, 1e-9);
    }
  }
  EXPECT_GT(found, 20);
}

// Where all leaves are neighbors and have one entry, a route in which no search finds a gain has no
// improving 3-opt move at all.
TEST(ThreeOpt, MissesNoImprovement) {
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Searched s(
        seed,
        {.shape = PlanShape::kFlatContours, .min_paths = 10, .max_paths = 10, .max_vertices = 1});
    ThreeOpt search(s.state, s.neighbors, Wide());
    for (bool found = true; found;) {
      found = false;
      for (int leaf = 0; leaf < s.tree.leaf_count() && !found; ++leaf) {
        for (const bool forward : {true, false}) {
          if (leaf == (forward ? s.tree.finish() : s.tree.start())) continue;
          search.Search(leaf, forward, 0);
          if (search.found().empty() || search.found()[0].delta > -1e-9) continue;
          s.state.Apply(search.found()[0].move);
          found = true;
          break;
        }
      }
    }
    s.state.Commit();
    const double reached = s.state.TotalCost();

    for (int kind = 0; kind < 5; ++kind) {
      for (int first = 1; first <= 10; ++first) {
        for (int middle = first; middle <= 10; ++middle) {
          for (int last = middle; last <= 10; ++last) {
            const SegmentMove move{static_cast<SegmentMove::Kind>(kind), first, middle, last};
            if ((kind == 0) != (middle == first) || !s.state.Allows(move)) continue;
            s.state.Apply(move);
            EXPECT_GE(s.state.TotalCost(), reached - 1e-6);
            s.state.UndoTo(0);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace traverse
