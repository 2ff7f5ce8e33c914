#include "engine/proof/tsp/support_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "tests/engine/proof/tsp/cut_weight.h"

namespace traverse {
namespace {

using testing::CutWeight;

// All sides without node 0.
std::vector<CutSide> AllSides(int nodes) {
  std::vector<CutSide> sides;
  for (int bits = 1; bits < 1 << (nodes - 1); ++bits) {
    CutSide side(static_cast<size_t>(nodes));
    for (int v = 1; v < nodes; ++v) side[static_cast<size_t>(v)] = (bits >> (v - 1)) & 1;
    sides.push_back(side);
  }
  return sides;
}

// A mix of some tours: each node has a weight of 2 around it, as in a programme's solution.
SupportGraph MixOfTours(Rng& rng, int nodes, int tours) {
  std::vector<std::vector<double>> weight(static_cast<size_t>(nodes),
                                          std::vector<double>(static_cast<size_t>(nodes)));
  for (int t = 0; t < tours; ++t) {
    // Two cycles each, so that there are small cuts.
    const int split = rng.Between(3, nodes - 3);
    for (const auto& [begin, end] : {std::pair{0, split}, std::pair{split, nodes}}) {
      std::vector<size_t> cycle;
      for (int v = begin; v < end; ++v) cycle.push_back(static_cast<size_t>(v));
      for (size_t i = cycle.size(); i-- > 1;) {
        std::swap(cycle[i], cycle[rng.Below(static_cast<uint32_t>(i) + 1)]);
      }
      for (size_t i = 0; i < cycle.size(); ++i) {
        const size_t a = cycle[i];
        const size_t b = cycle[(i + 1) % cycle.size()];
        weight[std::min(a, b)][std::max(a, b)] += 1.0 / tours;
      }
    }
  }
  SupportGraph graph;
  graph.nodes = nodes;
  for (int a = 0; a < nodes; ++a) {
    for (int b = a + 1; b < nodes; ++b) {
      const double w = weight[static_cast<size_t>(a)][static_cast<size_t>(b)];
      if (w > 0) graph.edges.push_back({a, b, w});
    }
  }
  return graph;
}

TEST(SmallCuts, FindsACutIfThereIsOne) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const SupportGraph graph = MixOfTours(rng, 9, rng.Between(1, 3));
    double smallest = 2;
    for (const CutSide& side : AllSides(9)) smallest = std::min(smallest, CutWeight(graph, side));

    const std::vector<CutSide> cuts = SmallCuts(graph, 1.99);

    EXPECT_EQ(cuts.empty(), smallest >= 1.99);
    for (const CutSide& side : cuts) {
      EXPECT_EQ(side[0], 0);
      EXPECT_THAT(side, ::testing::Contains(1));
      EXPECT_LT(CutWeight(graph, side), 1.99);
    }
  }
}

TEST(BestOddSet, IsTheBest) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    SupportGraph graph;
    graph.nodes = 2;
    const int edges = rng.Between(1, 8);
    for (int e = 0; e < edges; ++e) graph.edges.push_back({0, 1, rng.Unit()});
    double best = 100;
    for (int bits = 0; bits < 1 << edges; ++bits) {
      int count = 0;
      double sum = 0;
      for (int e = 0; e < edges; ++e) {
        const bool in = ((bits >> e) & 1) != 0;
        const double w = graph.edges[static_cast<size_t>(e)].weight;
        count += in ? 1 : 0;
        sum += in ? 1 - w : w;
      }
      if (count % 2 == 1) best = std::min(best, sum);
    }

    double sum = 0;
    const std::vector<int> odd = BestOddSet(graph, {0, 1}, sum);

    EXPECT_EQ(odd.size() % 2, 1u);
    EXPECT_NEAR(sum, best, 1e-12);
  }
}

// A triangle of halves with a whole edge at each corner: the smallest point that no mix of tours
// is.
TEST(OddCuts, FindsATriangleWithThreeTeeth) {
  SupportGraph graph;
  graph.nodes = 6;
  graph.edges = {{0, 1, 0.5}, {1, 2, 0.5}, {0, 2, 0.5}, {3, 4, 0.5}, {4, 5, 0.5},
                 {3, 5, 0.5}, {0, 3, 1},   {1, 4, 1},   {2, 5, 1}};

  const std::vector<CutSide> cuts = OddCuts(graph, 0.01);

  ASSERT_EQ(cuts.size(), 1u);
  double sum = 0;
  EXPECT_EQ(BestOddSet(graph, cuts[0], sum).size(), 3u);
  EXPECT_EQ(sum, 0);
}

}  // namespace
}  // namespace traverse
