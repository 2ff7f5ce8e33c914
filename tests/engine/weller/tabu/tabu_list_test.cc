#include "engine/weller/tabu/tabu_list.h"

#include <gtest/gtest.h>

namespace traverse {
namespace {

TEST(TabuList, ForbidsUntilTheTenureEnds) {
  TabuList list(3);
  list.Add(7, 10);

  EXPECT_TRUE(list.Forbids(7, 0));
  EXPECT_TRUE(list.Forbids(7, 9));
  EXPECT_FALSE(list.Forbids(7, 10));
  EXPECT_FALSE(list.Forbids(8, 0));
}

TEST(TabuList, DropsTheOldestWhenFull) {
  TabuList list(2);
  for (const uint64_t key : {1u, 2u, 3u}) list.Add(key, 100);

  EXPECT_FALSE(list.Forbids(1, 0));
  EXPECT_TRUE(list.Forbids(2, 0));
  EXPECT_TRUE(list.Forbids(3, 0));
}

TEST(TabuList, ALaterTenureOfTheSameMoveCounts) {
  TabuList list(2);
  list.Add(1, 5);
  list.Add(1, 9);

  EXPECT_TRUE(list.Forbids(1, 8));
}

TEST(TabuList, ForgetsAndMayBeEmpty) {
  TabuList list(2);
  list.Add(1, 5);
  list.Clear();
  EXPECT_FALSE(list.Forbids(1, 0));

  TabuList none(0);
  none.Add(1, 5);
  EXPECT_FALSE(none.Forbids(1, 0));
}

TEST(TabuList, GrowsAndShrinksWithItsNewestMoves) {
  TabuList list(2);
  list.Add(1, 100);
  list.Add(2, 100);
  list.Resize(3);
  list.Add(3, 100);
  EXPECT_TRUE(list.Forbids(1, 0) && list.Forbids(2, 0) && list.Forbids(3, 0));

  list.Resize(2);
  EXPECT_FALSE(list.Forbids(1, 0));
  EXPECT_TRUE(list.Forbids(2, 0) && list.Forbids(3, 0));
  list.Add(4, 100);
  EXPECT_FALSE(list.Forbids(2, 0));
  EXPECT_TRUE(list.Forbids(3, 0) && list.Forbids(4, 0));
}

}  // namespace
}  // namespace traverse
