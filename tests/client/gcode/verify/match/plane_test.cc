#include "client/gcode/verify/match/plane.h"

#include <gtest/gtest.h>

#include <vector>

namespace traverse::gcode {
namespace {

TEST(PiecesCross, WhereALineLeadsFromOneSideToTheOther) {
  EXPECT_TRUE(PiecesCross({0, 5}, {20, 5}, {10, 0}, {10, 10}));
  EXPECT_FALSE(PiecesCross({0, 5}, {9, 5}, {10, 0}, {10, 10}));
  // Through a corner of two lines, and past one.
  const auto crosses = [](Point before, Point corner, Point behind) {
    return PiecesCross({0, 5}, {20, 5}, before, corner) ||
           PiecesCross({0, 5}, {20, 5}, corner, behind);
  };
  EXPECT_TRUE(crosses({10, 10}, {12, 5}, {10, 0}));
  EXPECT_TRUE(crosses({10, 0}, {12, 5}, {10, 10}));
  EXPECT_FALSE(crosses({10, 10}, {12, 5}, {14, 10}));
  // Along a line that turns away.
  EXPECT_FALSE(crosses({30, 5}, {12, 5}, {12, 10}));
  EXPECT_FALSE(crosses({30, 5}, {12, 5 + 1e-12}, {12, 10}));
}

TEST(AppendPieces, CutsArcsIntoChordsHoweverLarge) {
  TraceChunk chunk;
  chunk.arcs = {{{5, 0}, false}, {{0, 1e12}, true}};
  chunk.segments = {{.end = {0, 0}, .arc = 0}, {.end = {1, 0}, .arc = 1}};
  chunk.paths.resize(1);
  chunk.paths[0].end_segment = 2;
  chunk.paths[0].start = {10, 0};
  std::vector<Piece> pieces;

  AppendPieces(chunk, 0, pieces);

  ASSERT_GT(pieces.size(), 20u);
  for (size_t i = 0; i + 17 < pieces.size(); ++i) {
    EXPECT_NEAR(Distance(pieces[i].b, {5, 0}), 5, 1e-9);
  }
  EXPECT_EQ(pieces.back().b.x, 1);
  EXPECT_LE(pieces.size(), 360u + 16u) << "an arc that no printer makes has few";
}

TEST(JoinEqual, LeavesOneOfThosePiecesThatLieInOnePlace) {
  std::vector<Piece> pieces = {{{0, 0}, {1, 0}, 4},
                               {{0, 0}, {1, 0}, 4},
                               {{1, 0}, {0, 0}, 5},
                               {{0, 0}, {2, 0}, 6},
                               {{0, 0}, {2, 0}, 7}};
  JoinEqual(pieces);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces[0].path, 4u);
  EXPECT_EQ(pieces[1].path, 5u);
  EXPECT_EQ(pieces[2].path, kSeveralPaths);
  EXPECT_EQ(pieces[2].b.x, 2);
}

TEST(LeaveOutCrowds, LeavesWhatCanBePrintedInOnePlace) {
  std::vector<Piece> pieces;
  for (uint32_t i = 0; i < 2500; ++i) pieces.push_back({{5.1, 5.1}, {5.1, 5.1 + i * 1e-4}, i});
  pieces.push_back({{7.5, 5.5}, {7.5, 6.5}, 2500});  // beside the crowd
  pieces.push_back({{0, 5.5}, {10, 5.5}, 2501});     // through it

  LeaveOutCrowds(pieces);

  EXPECT_GT(pieces.size(), 900u);
  EXPECT_LT(pieces.size(), 1500u);
  EXPECT_EQ(pieces.back().path, 2500u);
}

}  // namespace
}  // namespace traverse::gcode
