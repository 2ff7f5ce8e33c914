#include "engine/base/disjoint_sets.h"

#include <vector>

#include "gtest/gtest.h"

namespace traverse {
namespace {

TEST(DisjointSets, AreNumberedInTheOrderOfTheirFirstMembers) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.Numbered(), (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(sets.Join(5, 1));
  EXPECT_TRUE(sets.Join(4, 0));
  EXPECT_TRUE(sets.Join(3, 5));
  EXPECT_EQ(sets.Numbered(), (std::vector<int>{0, 1, 2, 1, 0, 1}));
}

TEST(DisjointSets, SayWhetherWhatIsJoinedWasApart) {
  DisjointSets sets(4);
  EXPECT_TRUE(sets.Join(0, 1));
  EXPECT_TRUE(sets.Join(2, 3));
  EXPECT_TRUE(sets.Join(1, 2));
  EXPECT_FALSE(sets.Join(3, 0));
  EXPECT_TRUE(sets.AreJoined(0, 2));
  EXPECT_FALSE(sets.Join(2, 2));
}

TEST(DisjointSets, AreAloneAfterReset) {
  DisjointSets sets(2);
  sets.Join(0, 1);
  sets.Reset(3);
  EXPECT_FALSE(sets.AreJoined(0, 1));
  EXPECT_EQ(sets.Numbered(), (std::vector<int>{0, 1, 2}));
}

}  // namespace
}  // namespace traverse
