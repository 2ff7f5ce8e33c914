// Islands that count as one: client/gcode/island_tree.h, island_map.h.

#include "client/gcode/island_tree.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "client/gcode/island_map.h"

namespace traverse::gcode {
namespace {

std::set<std::set<uint32_t>> Nodes(const IslandTree& tree) {
  std::vector<std::set<uint32_t>> parts(tree.size());
  for (uint32_t node = 0; node < tree.size(); ++node) {
    if (node < tree.count()) parts[node] = {node};
    const std::set<uint32_t> part = parts[node];
    if (tree.ParentOf(node) != node) parts[tree.ParentOf(node)].insert(part.begin(), part.end());
  }
  return {parts.begin(), parts.end()};
}

using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;

Pairs PairsOf(const IslandTree& below, uint32_t one, const IslandTree& above, uint32_t other) {
  Pairs pairs;
  IslandTree::ForEachPair(below, one, above, other,
                          [&](uint32_t a, uint32_t b) { pairs.emplace_back(a, b); });
  return pairs;
}

TEST(IslandTree, JoinsTheNearestFirst) {
  const IslandTree tree(4, {{1, 2, 1.9}, {0, 1, 1.4}, {2, 3, 2.2}});

  EXPECT_EQ(Nodes(tree), (std::set<std::set<uint32_t>>{{0}, {1}, {2}, {3}, {0, 1}, {0, 1, 2}}));
  EXPECT_EQ(tree.RootOf(0), tree.RootOf(2));
  EXPECT_EQ(tree.RootOf(3), 3u);
}

TEST(IslandTree, JoinsAtOnceWhatIsEquallyFar) {
  const IslandTree chain(3, {{0, 1, 1.51}, {1, 2, 1.52}});
  const IslandTree pairs(4, {{0, 1, 1.51}, {2, 3, 1.52}, {1, 2, 1.53}});

  EXPECT_EQ(PairsOf(chain, 0, chain, 2), (Pairs{{0, 2}, {chain.RootOf(1), chain.RootOf(1)}}));
  EXPECT_EQ(PairsOf(pairs, 0, pairs, 2), (Pairs{{0, 2}, {pairs.RootOf(1), pairs.RootOf(1)}}));
}

// A ladder of pairs, each of which is joined to the next one at the distance at which it came to
// be.
TEST(IslandTree, NoNodeHasMoreAboveItThanThereAreSteps) {
  constexpr uint32_t kPairs = 1000;
  std::vector<IslandGap> gaps;
  for (uint32_t i = 0; i < kPairs; ++i) gaps.push_back({i, kPairs + i, 1.5});
  for (uint32_t i = 0; i + 1 < kPairs; ++i) gaps.push_back({kPairs + i, kPairs + i + 1, 1.5});
  const IslandTree tree(2 * kPairs, gaps);

  for (uint32_t island = 0; island < tree.count(); ++island) {
    const uint32_t whole = tree.ParentOf(island);
    EXPECT_EQ(whole, tree.RootOf(0)) << island;
  }
}

TEST(IslandTree, PairsAreThoseAtTheSameDistance) {
  const IslandTree below(2, {{0, 1, 1.4}});
  const IslandTree above(2, {{0, 1, 1.9}});

  EXPECT_EQ(PairsOf(below, 0, above, 1), (Pairs{{0, 1}, {2, 1}, {2, 2}}));
  EXPECT_EQ(PairsOf(IslandTree(1), 0, IslandTree(1), 0), (Pairs{{0, 0}}));
}

TEST(IslandMap, IslandsAreAsFarApartAsTheirNearestLines) {
  IslandMap map(4);
  map.AddLine(0, 0, 20, 0, 0);
  map.AddLine(10, 1.3, 10, 9, 1);
  map.AddLine(11.8, 2.5, 11.8, 9, 2);
  map.AddLine(0, -2.4, 20, -2.4, 3);

  const IslandTree tree = map.TakeTree();

  EXPECT_EQ(Nodes(tree), (std::set<std::set<uint32_t>>{{0}, {1}, {2}, {3}, {0, 1}, {0, 1, 2}}));
  EXPECT_GE(map.TakeCells().size(), 20u + 8 + 7 + 20);
}

TEST(IslandMap, CrowdsOfPointsCountForThemselves) {
  IslandMap map(2);
  for (int i = 0; i < 2000; ++i) {
    map.AddLine(0, 0, 1, 0, 0);
    map.AddLine(0, 1.5, 1, 1.5, 1);
  }

  EXPECT_EQ(map.TakeTree().size(), 2u);
}

// Of the chord of a huge arc as much as of any other line.
TEST(IslandMap, FarLinesAreLookedAtWhereThePlateIs) {
  IslandMap map(1);
  map.AddLine(-1e6, 5.5, 1e6, 5.5, 0);
  map.AddLine(1e6, -1e6, 1e6, 1e6, 0);
  map.AddLine(4001, 4001, 9000, 9000, 0);

  const std::vector<IslandCell> cells = map.TakeCells();

  EXPECT_NEAR(static_cast<double>(cells.size()), 2 * kFarthestMm, 1);
  for (const IslandCell& cell : cells) EXPECT_EQ(static_cast<uint32_t>(cell.first), 5u);
}

TEST(IslandMap, LinesInOnePlaceFillIt) {
  IslandMap map(1);
  int lines = 0;
  for (; !map.full() && lines < 1000; ++lines) map.AddLine(-4000, 5.5, 4000, 5.5, 0);

  EXPECT_NEAR(lines, kMostPointsOfLayer / 16000, 1);
}

}  // namespace
}  // namespace traverse::gcode
