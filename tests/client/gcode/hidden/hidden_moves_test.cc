// Which moves nobody sees: client/gcode/hidden.

#include "client/gcode/hidden/hidden_moves.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/stack.h"

namespace traverse::gcode {
namespace {

using testing::Stack;

constexpr double kLongestMm = 30;

// Four layers of a box of 20 mm; `odd` adds to the second of them, `below` and `above` to those
// beside it.
class InABox : public ::testing::Test {
 protected:
  using Adds = std::function<void(Stack&)>;

  static void Nothing(Stack&) {}

  static bool Hides(Point a, Point b, const Adds& here = Nothing, const Adds& below = Nothing,
                    const Adds& above = Nothing, bool leaves_wall = false) {
    Stack stack;
    const Adds layers[] = {below, here, above, Nothing};
    for (int i = 0; i < 4; ++i) {
      stack.Layer(0.2 * (i + 1)).Box(0, 0, 20);
      layers[i](stack);
    }
    const std::shared_ptr<GcodeFile> file = testing::Read(stack.Text());
    EXPECT_EQ(file->layers.size(), 4u);
    return HiddenMoves(*file, kLongestMm).Hides(1, a, b, leaves_wall);
  }
};

TEST_F(InABox, MovesInsideAreHiddenButInTheFirstAndTheLastLayer) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6, 0.8}) stack.Layer(z).Box(0, 0, 20);
  const HiddenMoves moves(*testing::Read(stack.Text()), kLongestMm);
  for (const size_t layer : {0u, 3u}) EXPECT_FALSE(moves.Hides(layer, {3, 3}, {16, 15}, false));
  for (const size_t layer : {1u, 2u}) {
    EXPECT_TRUE(moves.Hides(layer, {3, 3}, {16, 15}, false));
    EXPECT_TRUE(moves.Hides(layer, {16, 15}, {3, 3}, false));
    EXPECT_TRUE(moves.Hides(layer, {3, 3}, {3, 15}, false));
    EXPECT_FALSE(moves.Hides(layer, {3, 3}, {25, 15}, false));
    EXPECT_FALSE(moves.Hides(layer, {-3, 3}, {16, 15}, false));
    EXPECT_FALSE(moves.Hides(layer, {1e12, 3}, {1e12, 4}, false));
  }
}

TEST_F(InABox, LongMovesAreNot) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) stack.Layer(z).Box(0, 0, 50);
  const std::shared_ptr<GcodeFile> file = testing::Read(stack.Text());
  EXPECT_TRUE(HiddenMoves(*file, 30).Hides(1, {5, 5}, {34, 5}, false));
  EXPECT_FALSE(HiddenMoves(*file, 30).Hides(1, {5, 5}, {36, 5}, false));
  EXPECT_TRUE(HiddenMoves(*file, 32).Hides(1, {5, 5}, {36, 5}, false));
  EXPECT_FALSE(HiddenMoves(*file, 10).Hides(1, {5, 5}, {16, 5}, false));
}

TEST_F(InABox, HolesOfTheLayerAndOfThoseBesideItAreSeen) {
  const Adds hole = [](Stack& stack) { stack.Wall(8, 8, 4); };
  const Point a{5, 10};
  const Point b{15, 10};
  EXPECT_TRUE(Hides(a, b));
  EXPECT_FALSE(Hides(a, b, hole));
  EXPECT_FALSE(Hides(a, b, Nothing, hole));
  EXPECT_FALSE(Hides(a, b, Nothing, Nothing, hole));
  EXPECT_TRUE(Hides({5, 5}, {15, 5}, hole, hole, hole));
  EXPECT_FALSE(Hides({5, 10}, {10, 10}, Nothing, Nothing, hole));
}

TEST_F(InABox, HolesWhoseWallIsPrintedInPiecesAreSeen) {
  const Adds pieces = [](Stack& stack) { stack.Corner(8, 8, 4).Corner(12, 12, -4); };
  EXPECT_FALSE(Hides({5, 10}, {15, 10}, pieces));
  EXPECT_FALSE(Hides({5, 10}, {15, 10}, Nothing, pieces));
  EXPECT_FALSE(Hides({5, 10}, {15, 10}, Nothing, Nothing, pieces));
  EXPECT_TRUE(Hides({5, 5}, {15, 5}, pieces, pieces, pieces));
}

TEST_F(InABox, APartWithinAPartIsAnother) {
  const Adds other = [](Stack& stack) { stack.Wall(5, 5, 10).Wall(8, 8, 4).Line(9, 10, 2); };
  EXPECT_FALSE(Hides({3, 10}, {9, 10}, other, other, other));
  EXPECT_FALSE(Hides({6, 10}, {6, 12}, other, other, other));
  EXPECT_TRUE(Hides({9, 9}, {11, 11}, other, other, other));
}

TEST_F(InABox, MovesKeepAwayFromWallsThatTheyDoNotLeave) {
  EXPECT_FALSE(Hides({3, 0.15}, {16, 0.15}));
  EXPECT_TRUE(Hides({3, 0.45}, {16, 0.45}));
  EXPECT_FALSE(Hides({0, 5}, {16, 5}));
  const auto leaving = [](Point a, Point b) {
    return Hides(a, b, Nothing, Nothing, Nothing, /*leaves_wall=*/true);
  };
  EXPECT_TRUE(leaving({0, 5}, {16, 5}));
  EXPECT_TRUE(leaving({0, 0}, {16, 15}));
  EXPECT_FALSE(leaving({0, 5}, {0, 15}));  // along it
  EXPECT_FALSE(leaving({0, 5}, {-5, 5}));  // outside
  EXPECT_FALSE(leaving({0, 5}, {20, 5}));  // to another one
}

TEST(HiddenMoves, WhatTheNextLayerLeavesUncoveredIsSeenAndWhatHangsOverToo) {
  Stack stack;
  for (const double z : {0.2, 0.4}) stack.Layer(z).Box(0, 0, 20);
  stack.Layer(0.6).Box(0, 0, 10);
  stack.Layer(0.8).Box(0, 0, 20).Layer(1).Box(0, 0, 20);
  const HiddenMoves moves(*testing::Read(stack.Text()), kLongestMm);
  for (const size_t layer : {1u, 3u}) {
    EXPECT_TRUE(moves.Hides(layer, {3, 3}, {7, 7}, false));
    EXPECT_FALSE(moves.Hides(layer, {3, 3}, {13, 7}, false));
    EXPECT_FALSE(moves.Hides(layer, {13, 3}, {13, 7}, false));
  }
}

TEST(HiddenMoves, AWallAloneAndASkirtAreNoPart) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) {
    stack.Layer(z).Wall(0, 0, 20).Add(";TYPE:Skirt/Brim\n").Add(Stack::Open(5, 5));
    stack.Add("G1 E.8 F2100\nG1 X15 Y5 E.4 F1200\nG1 E-.8 F2100\n");
  }
  EXPECT_FALSE(HiddenMoves(*testing::Read(stack.Text()), 30).Hides(1, {3, 3}, {16, 15}, false));
}

TEST(HiddenMoves, LayersOfTheNextObjectCoverNothing) {
  Stack stack;
  for (const double x : {0.0, 0.0}) {
    for (const double z : {0.2, 0.4, 0.6}) stack.Layer(z).Box(x, 0, 20);
  }
  const HiddenMoves moves(*testing::Read(stack.Text()), kLongestMm);
  for (size_t layer = 0; layer < 6; ++layer) {
    EXPECT_EQ(moves.Hides(layer, {3, 3}, {16, 15}, false), layer % 3 == 1) << layer;
  }
}

TEST(HiddenMoves, NothingIsHiddenInLayersOfTwoTools) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) {
    stack.Layer(z).Box(0, 0, 20).Add(z == 0.4 ? "T1\n" : "").Box(30, 0, 20);
  }
  EXPECT_FALSE(HiddenMoves(*testing::Read(stack.Text()), 30).Hides(1, {3, 3}, {16, 15}, false));
}

}  // namespace
}  // namespace traverse::gcode
