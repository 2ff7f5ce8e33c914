#include "client/gcode/verify/match/plane.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace traverse::gcode {
namespace {

std::vector<Piece> RandomPieces(std::mt19937& random, uint32_t count, double room) {
  std::uniform_real_distribution<double> along(0, room);
  std::vector<Piece> pieces;
  for (uint32_t i = 0; i < count; ++i) {
    const Point from{along(random), along(random)};
    pieces.push_back({from, {from.x + along(random) / 20, from.y - along(random) / 20}, i});
  }
  return pieces;
}

TEST(PieceGrid, FindsWhatIsNear) {
  std::mt19937 random(1);
  const PieceGrid grid(RandomPieces(random, 300, 100), 2);
  std::uniform_real_distribution<double> anywhere(-50, 150);
  for (int i = 0; i < 200; ++i) {
    const Point a{anywhere(random), anywhere(random)};
    const Point b{anywhere(random), anywhere(random)};
    std::set<uint32_t> near;
    std::set<uint32_t> along;
    grid.ForEachNear(a, b, 1.5, [&](uint32_t index) { return near.insert(index), true; });
    grid.ForEachAlong(a, b, [&](uint32_t index) { return along.insert(index), true; });
    for (uint32_t k = 0; k < grid.pieces().size(); ++k) {
      const Piece& piece = grid.pieces()[k];
      const bool is_near = DistanceOfPieces(a, b, piece.a, piece.b) <= 1.5;
      EXPECT_TRUE(!is_near || near.contains(k));
      EXPECT_TRUE(!PiecesCross(a, b, piece.a, piece.b) || along.contains(k));
    }
  }
}

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

// Damaged files lead a thousand kilometres away.
TEST(PieceGrid, IsAskedForPlacesAnywhere) {
  std::mt19937 random(2);
  const PieceGrid grid(RandomPieces(random, 50, 100), 2);
  int seen = 0;
  const auto count = [&seen](uint32_t) { return ++seen, true; };
  grid.ForEachNear({1e15, -1e15}, {1e15, 1e15}, 1, count);
  grid.ForEachAlong({-1e15, 50}, {1e15, 50}, count);
  EXPECT_GT(seen, 0);
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
  for (size_t i = 0; i + 361 < pieces.size(); ++i) {
    EXPECT_NEAR(DistanceOf(pieces[i].b, {5, 0}), 5, 1e-9);
  }
  EXPECT_EQ(pieces.back().b.x, 1);
  EXPECT_LE(pieces.size(), 720u);
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

}  // namespace
}  // namespace traverse::gcode
