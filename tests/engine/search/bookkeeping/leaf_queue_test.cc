#include "engine/search/bookkeeping/leaf_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace traverse {
namespace {

using ::testing::ElementsAre;

constexpr int kPaths = 4;
constexpr int kStart = 4;
constexpr int kFinish = 5;

std::vector<int> PopAll(LeafQueue& queue) {
  std::vector<int> popped;
  while (!queue.empty()) popped.push_back(queue.Pop());
  return popped;
}

TEST(LeafQueue, GivesEachLeafOnceFirstInFirstOut) {
  LeafQueue queue(kPaths, kPaths + 2);
  for (const int leaf : {2, 0, 2, 3}) queue.Push(leaf);
  EXPECT_EQ(queue.Pop(), 2);
  for (const int leaf : {1, 2, 0}) queue.Push(leaf);
  EXPECT_THAT(PopAll(queue), ElementsAre(0, 3, 1, 2));
}

TEST(LeafQueue, HoldsNeitherStartNorFinish) {
  LeafQueue queue(kPaths, kPaths + 2);
  queue.Push(kStart);
  queue.PushPair(3, kFinish);
  EXPECT_THAT(PopAll(queue), ElementsAre(3));
}

TEST(LeafQueue, KnowsWhichMovesChanged) {
  LeafQueue queue(kPaths, kPaths + 2);
  queue.PushPair(0, 1);
  EXPECT_TRUE(queue.Changed(0, 1));
  EXPECT_TRUE(queue.Changed(1, 0));
  EXPECT_FALSE(queue.Changed(1, 2));

  queue.PushPair(1, 2);
  queue.PushPair(1, 2);
  EXPECT_TRUE(queue.Changed(1, 0));
  EXPECT_TRUE(queue.Changed(1, 2));

  // A leaf has two moves: with a third one, the first one is gone.
  queue.PushPair(1, 3);
  EXPECT_FALSE(queue.Changed(1, 0));
  EXPECT_TRUE(queue.Changed(1, 2));

  queue.Push(1);
  queue.PushPair(1, 2);
  EXPECT_TRUE(queue.Changed(1, 0));
}

TEST(LeafQueue, ForgetsWhatWasLookedAtUnlessItIsToBeLookedAtAgain) {
  LeafQueue queue(kPaths, kPaths + 2);
  queue.PushPair(0, 1);
  EXPECT_EQ(queue.Pop(), 0);
  queue.PushPair(0, 2);
  queue.Forget(0);
  EXPECT_TRUE(queue.Changed(0, 1));
  EXPECT_THAT(PopAll(queue), ElementsAre(1, 0, 2));
  queue.Forget(0);
  EXPECT_FALSE(queue.Changed(0, 1));
  EXPECT_FALSE(queue.Changed(0, 2));
}

TEST(LeafQueue, ForgetsAllWhenCleared) {
  LeafQueue queue(kPaths, kPaths + 2);
  queue.Push(2);
  queue.PushPair(kStart, 0);
  queue.Clear();
  EXPECT_TRUE(queue.empty());
  EXPECT_FALSE(queue.Changed(2, 0));
  EXPECT_FALSE(queue.Changed(kStart, 0));
  queue.Push(2);
  EXPECT_THAT(PopAll(queue), ElementsAre(2));
}

}  // namespace
}  // namespace traverse
