#include "engine/search/bookkeeping/rejected_moves.h"

#include <gtest/gtest.h>

#include <vector>

namespace traverse {
namespace {

using Kind = SegmentMove::Kind;

TEST(RejectedMoves, KnowsTheMovesOfThisRouteAndNoOthers) {
  RejectedMoves rejected;
  const SegmentMove move{Kind::kExchange, 3, 5, 9};
  rejected.Add(move, 7);

  EXPECT_TRUE(rejected.Contains(move, 7));
  EXPECT_FALSE(rejected.Contains(move, 8));
  EXPECT_FALSE(rejected.Contains({Kind::kReverseBoth, 3, 5, 9}, 7));
  EXPECT_FALSE(rejected.Contains({Kind::kExchange, 2, 5, 9}, 7));
  EXPECT_FALSE(rejected.Contains({Kind::kExchange, 3, 4, 9}, 7));
  EXPECT_FALSE(rejected.Contains({Kind::kExchange, 3, 5, 8}, 7));
}

// Also where they share a place of the table.
TEST(RejectedMoves, NeverTakesAMoveForAnother) {
  RejectedMoves rejected;
  std::vector<SegmentMove> moves;
  for (int first = 1; first <= 20; ++first) {
    for (int last = first + 1; last <= 40; ++last) {
      moves.push_back({Kind::kExchange, first, first + 1, last});
    }
  }
  for (const SegmentMove& move : moves) {
    EXPECT_FALSE(rejected.Contains(move, 1));
    rejected.Add(move, 1);
    EXPECT_TRUE(rejected.Contains(move, 1));
  }
}

}  // namespace
}  // namespace traverse
