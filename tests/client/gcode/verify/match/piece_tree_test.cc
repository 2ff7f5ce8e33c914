#include "client/gcode/verify/match/piece_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>
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

TEST(PieceTree, FindsWhatIsNear) {
  std::mt19937 random(1);
  const PieceTree tree(RandomPieces(random, 300, 100));
  std::uniform_real_distribution<double> anywhere(-50, 150);
  for (int i = 0; i < 200; ++i) {
    const Point a{anywhere(random), anywhere(random)};
    const Point b{anywhere(random), anywhere(random)};
    std::set<uint32_t> near;
    std::set<uint32_t> along;
    tree.ForEachNear(a, b, 1.5, [&](uint32_t index) { return near.insert(index), true; });
    tree.AnyAcross(a, b, [&](const Piece& piece) { return along.insert(piece.path), false; });
    for (uint32_t k = 0; k < tree.pieces().size(); ++k) {
      const Piece& piece = tree.pieces()[k];
      const bool is_near = DistanceOfPieces(a, b, piece.a, piece.b) <= 1.5;
      EXPECT_TRUE(!is_near || near.contains(k));
      EXPECT_TRUE(!PiecesCross(a, b, piece.a, piece.b) || along.contains(k));
    }
  }
}

// Damaged files lead a thousand kilometres away.
TEST(PieceTree, IsAskedForPlacesAnywhere) {
  std::mt19937 random(2);
  const PieceTree tree(RandomPieces(random, 50, 100));
  int seen = 0;
  const auto count = [&seen](uint32_t) { return ++seen, true; };
  tree.ForEachNear({1e15, -1e15}, {1e15, 1e15}, 1, count);
  tree.AnyAcross({-1e15, 50}, {1e15, 50}, [&seen](const Piece&) { return ++seen, false; });
  EXPECT_GT(seen, 0);
}

// Squares of `side` mm in a row, 1 mm apart.
std::vector<Piece> RowOfSquares(uint32_t count, double side) {
  std::vector<Piece> pieces;
  for (uint32_t i = 0; i < count; ++i) {
    const double x = i;
    pieces.push_back({{x, 0}, {x + side, 0}, i});
    pieces.push_back({{x + side, 0}, {x + side, side}, i});
    pieces.push_back({{x + side, side}, {x, side}, i});
    pieces.push_back({{x, side}, {x, 0}, i});
  }
  return pieces;
}

int VisitedAlong(const PieceTree& tree, Point a, Point b) {
  int visited = 0;
  tree.AnyAcross(a, b, [&](const Piece&) { return ++visited, false; });
  return visited;
}

// With cells of one size, and no more of them than pieces, all squares would be in one.
TEST(PieceTree, FindsFewWhereOneLiesFarAway) {
  std::vector<Piece> pieces = RowOfSquares(1000, 0.5);
  pieces.push_back({{9e5, 9e5}, {9e5 + 1, 9e5}, 1000});
  pieces.push_back({{0, 10}, {9e5, 9e5}, 1001});
  const PieceTree tree(std::move(pieces));

  EXPECT_GE(VisitedAlong(tree, {500.2, -1}, {500.2, 1}), 2);
  EXPECT_LE(VisitedAlong(tree, {500.2, -1}, {500.2, 1}), 40);
}

TEST(PieceTree, PassesByACrowdThatALineDoesNotMeet) {
  const PieceTree tree(RowOfSquares(1000, 0.01));

  EXPECT_EQ(VisitedAlong(tree, {-5, 0.1}, {1005, 0.1}), 0);
}

// Along their edges, which crosses none.
TEST(PieceTree, PassesAsManyAsAPrintHasAndNoMore) {
  const Point a{-5, 0};
  const Point b{20'000, 0};
  const auto all = [](const Piece&) { return true; };
  EXPECT_FALSE(PieceTree(RowOfSquares(500, 0.5)).AnyAcross(a, b, all));

  const PieceTree row(RowOfSquares(10'000, 0.5));
  uint32_t looked = 0;
  EXPECT_TRUE(row.AnyAcross(a, b, [&looked](const Piece&) { return ++looked, true; }));
  EXPECT_EQ(looked, PieceTree::kMostPassed);
}

// Whose boxes all hold the same place.
TEST(PieceTree, FindsFewOfLongDiagonals) {
  std::vector<Piece> pieces;
  for (uint32_t i = 0; i < 400; ++i) pieces.push_back({{0.4 * i, 0}, {0.4 * i + 100, 100}, i});
  const PieceTree tree(std::move(pieces));

  EXPECT_GE(VisitedAlong(tree, {120, 60}, {121, 60}), 2);
  EXPECT_LE(VisitedAlong(tree, {120, 60}, {121, 60}), 48);
}

// Lines of a kilometer are entered in few parts: a file of a megabyte may have thousands.
TEST(PieceTree, HasAFewNodesForEachPieceHoweverLong) {
  std::vector<Piece> pieces;
  for (uint32_t i = 0; i < 20'000; ++i) pieces.push_back({{0.1 * i, 0}, {0, 1e6}, i});

  EXPECT_LT(PieceTree(std::move(pieces)).node_count(), 65'000u);
}

}  // namespace
}  // namespace traverse::gcode
