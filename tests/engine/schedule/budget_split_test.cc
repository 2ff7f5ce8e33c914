#include "engine/schedule/budget_split.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

namespace traverse {
namespace {

using Clock = Budget::Clock;
using std::chrono::milliseconds;

const Clock::time_point kNow{};
const Clock::time_point kEnd = kNow + milliseconds(1000);

// Kept at the end of a second for a thread that loses its core.
constexpr milliseconds kLag{10};

// A split of a second among layers of these weights, and no others.
BudgetSplit SplitOf(double weights, int threads = 1) {
  BudgetSplit split(kEnd + kLag, kNow, threads);
  split.Add(weights);
  split.AnnounceEnd();
  return split;
}

TEST(BudgetSplit, EveryLayerGetsTheSameIfAllUseTheirs) {
  BudgetSplit split = SplitOf(10 * 3.0);

  Clock::time_point at = kNow;
  for (int i = 0; i < 10; ++i) {
    const Clock::duration allotted = split.Begin(3, at);

    EXPECT_NEAR(std::chrono::duration<double>(allotted).count(), 0.1, 1e-6);
    at += allotted;
  }
}

TEST(BudgetSplit, TimeIsSplitByWeight) {
  BudgetSplit split = SplitOf(10);

  EXPECT_EQ(split.Begin(1, kNow), milliseconds(100));
  EXPECT_EQ(split.Begin(9, kNow + milliseconds(100)), milliseconds(900));
}

TEST(BudgetSplit, TimeNotUsedIsLeftToOthersAndTimeOverusedTakenFromThem) {
  for (const auto& [used_ms, next_ms] : {std::pair(0, 500), std::pair(900, 50)}) {
    BudgetSplit split = SplitOf(3);
    split.Begin(1, kNow);

    EXPECT_EQ(split.Begin(1, kNow + milliseconds(used_ms)), milliseconds(next_ms));
  }
}

TEST(BudgetSplit, ThreadsShareTheLayers) {
  BudgetSplit split = SplitOf(8, 4);

  EXPECT_EQ(split.Begin(1, kNow), milliseconds(500));

  BudgetSplit few = SplitOf(2, 4);

  EXPECT_EQ(few.Begin(1, kNow), milliseconds(1000));
}

TEST(BudgetSplit, AGoodRouteLeavesLessToGain) {
  EXPECT_LT(BudgetSplit::Weight(100, true), BudgetSplit::Weight(100, false));
  EXPECT_GT(BudgetSplit::Weight(200, false), 2 * BudgetSplit::Weight(100, false));
}

TEST(BudgetSplit, WhileMoreMayComeHalfIsKeptForIt) {
  const LayerSize size{10, 40};
  BudgetSplit split(kEnd + kLag, kNow, 4);
  split.AddLayer(size);
  const Clock::duration first = split.Begin(BudgetSplit::Weight(size.paths, false), kNow);
  split.AddLayer(size);
  split.AnnounceEnd();
  const Clock::duration last = split.Begin(BudgetSplit::Weight(size.paths, false), kNow);

  EXPECT_NEAR(std::chrono::duration<double>(first).count(), 0.5, 1e-3);
  EXPECT_NEAR(std::chrono::duration<double>(last).count(), 1, 1e-3);
}

TEST(BudgetSplit, AnnouncedLayersShareBeforeTheyAreAdded) {
  const LayerSize size{10, 40};
  BudgetSplit split(kEnd + kLag, kNow, 1);
  for (int i = 0; i < 4; ++i) split.Announce(size);
  split.AnnounceEnd();

  Clock::time_point at = kNow;
  for (int i = 0; i < 4; ++i) {
    split.AddLayer(size);
    const Clock::duration allotted = split.Begin(BudgetSplit::Weight(size.paths, false), at);
    EXPECT_NEAR(std::chrono::duration<double>(allotted).count(), 0.25, 1e-3) << i;
    at += allotted;
  }
}

TEST(BudgetSplit, KeepsTheTimeOfGreedyForEveryLayerNotYetAnswered) {
  const LayerSize size{10, 40};
  BudgetSplit split(kEnd + kLag, kNow, 1);
  for (int i = 0; i < 3; ++i) split.AddLayer(size);
  split.Announce(size);
  split.NoteTaken(size, milliseconds(50));

  // Twice the time of each of four layers, then of one.
  const auto seconds_at_end = [&] {
    return std::chrono::duration<double>(kEnd - *split.SearchEnd()).count();
  };
  EXPECT_NEAR(seconds_at_end(), 4 * 0.1, 0.01);
  for (int i = 0; i < 3; ++i) split.NoteAnswered(size);
  EXPECT_NEAR(seconds_at_end(), 0.1, 0.01);
}

TEST(BudgetSplit, GreedyLeavesTheOtherLayersTheirTime) {
  const LayerSize small{10, 40};
  const LayerSize huge{100'000, 400'000};
  BudgetSplit split(kEnd, kNow, 1);
  for (int i = 0; i < 4; ++i) split.AddLayer(small);
  split.AddLayer(huge);
  split.NoteTaken(small, milliseconds(5));

  // Twice the time of four layers; alone it may take a little longer than its time.
  EXPECT_LT(*split.GreedyEnd(huge), kEnd - milliseconds(25));
  EXPECT_GT(*split.GreedyEnd(huge), kEnd - milliseconds(45));
  for (int i = 0; i < 4; ++i) split.NoteAnswered(small);
  EXPECT_GE(*split.GreedyEnd(huge), kEnd);
}

TEST(BudgetSplit, TasksThatWaitForAThreadEndTheSearchEarlier) {
  BudgetSplit split = SplitOf(1);

  split.NoteWait(milliseconds(100));

  EXPECT_EQ(kEnd - *split.SearchEnd(), milliseconds(200));
}

TEST(BudgetSplit, WithoutADeadlineThereIsNoLimitAndAfterItNothing) {
  BudgetSplit endless(std::nullopt, kNow, 1);
  endless.Add(1);
  BudgetSplit over(kNow, kNow, 1);
  over.Add(1);

  EXPECT_EQ(endless.Begin(1, kNow), Clock::duration::max());
  EXPECT_EQ(endless.SearchEnd(), std::nullopt);
  EXPECT_EQ(over.Begin(1, kNow + milliseconds(5)), Clock::duration::zero());
}

}  // namespace
}  // namespace traverse
