#include "engine/schedule/budget_split.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

namespace traverse {
namespace {

using Clock = Budget::Clock;
using std::chrono::milliseconds;

const Clock::time_point kNow{};

TEST(BudgetSplit, EveryLayerGetsTheSameIfAllUseTheirs) {
  BudgetSplit split(kNow + milliseconds(1000), 1);
  split.Add(10 * 3.0);

  Clock::time_point at = kNow;
  for (int i = 0; i < 10; ++i) {
    const Clock::duration allotted = split.Begin(3, at);

    EXPECT_NEAR(std::chrono::duration<double>(allotted).count(), 0.1, 1e-6);
    at += allotted;
  }
}

TEST(BudgetSplit, TimeIsSplitByWeight) {
  BudgetSplit split(kNow + milliseconds(1000), 1);
  split.Add(1);
  split.Add(9);

  EXPECT_EQ(split.Begin(1, kNow), milliseconds(100));
  EXPECT_EQ(split.Begin(9, kNow + milliseconds(100)), milliseconds(900));
}

TEST(BudgetSplit, TimeNotUsedIsLeftToOthersAndTimeOverusedTakenFromThem) {
  for (const auto& [used_ms, next_ms] : {std::pair(0, 500), std::pair(900, 50)}) {
    BudgetSplit split(kNow + milliseconds(1000), 1);
    split.Add(3);
    split.Begin(1, kNow);

    EXPECT_EQ(split.Begin(1, kNow + milliseconds(used_ms)), milliseconds(next_ms));
  }
}

TEST(BudgetSplit, ThreadsShareTheLayers) {
  BudgetSplit split(kNow + milliseconds(1000), 4);
  split.Add(8);

  EXPECT_EQ(split.Begin(1, kNow), milliseconds(500));

  BudgetSplit few(kNow + milliseconds(1000), 4);
  few.Add(2);

  EXPECT_EQ(few.Begin(1, kNow), milliseconds(1000));
}

TEST(BudgetSplit, AGoodRouteLeavesLessToGain) {
  EXPECT_LT(BudgetSplit::Weight(100, true), BudgetSplit::Weight(100, false));
  EXPECT_GT(BudgetSplit::Weight(200, false), 2 * BudgetSplit::Weight(100, false));
}

TEST(BudgetSplit, WithoutADeadlineThereIsNoLimitAndAfterItNothing) {
  BudgetSplit endless(std::nullopt, 1);
  endless.Add(1);
  BudgetSplit over(kNow, 1);
  over.Add(1);

  EXPECT_EQ(endless.Begin(1, kNow), Clock::duration::max());
  EXPECT_EQ(over.Begin(1, kNow + milliseconds(5)), Clock::duration::zero());
}

}  // namespace
}  // namespace traverse
