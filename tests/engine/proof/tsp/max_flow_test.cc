#include "engine/proof/tsp/max_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "tests/engine/proof/tsp/cut_weight.h"

namespace traverse {
namespace {

using testing::CutWeight;

constexpr int kNodes = 8;

SupportGraph RandomGraph(Rng& rng) {
  SupportGraph graph;
  graph.nodes = kNodes;
  for (int a = 0; a < kNodes; ++a) {
    for (int b = a + 1; b < kNodes; ++b) {
      if (rng.Below(2) == 0) graph.edges.push_back({a, b, rng.Unit()});
    }
  }
  return graph;
}

// Of all sides with `sources` and without `sink`.
double SmallestCut(const SupportGraph& graph, const std::vector<int>& sources, int sink) {
  double least = std::numeric_limits<double>::infinity();
  for (int bits = 0; bits < 1 << kNodes; ++bits) {
    std::vector<char> side(kNodes);
    for (int v = 0; v < kNodes; ++v) side[static_cast<size_t>(v)] = (bits >> v) & 1;
    if (side[static_cast<size_t>(sink)] != 0) continue;
    if (std::any_of(sources.begin(), sources.end(),
                    [&](int source) { return side[static_cast<size_t>(source)] == 0; })) {
      continue;
    }
    least = std::min(least, CutWeight(graph, side));
  }
  return least;
}

TEST(MaxFlow, IsTheSmallestCut) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const SupportGraph graph = RandomGraph(rng);
    MaxFlow flow(graph);
    for (const std::vector<int>& sources : {std::vector<int>{0}, {1, 2}, {3, 0, 5}}) {
      const double least = SmallestCut(graph, sources, 7);

      EXPECT_NEAR(flow.Send(sources, 7, 100), least, 1e-6);

      EXPECT_NEAR(CutWeight(graph, flow.source_side()), least, 1e-6);
      EXPECT_EQ(flow.source_side()[7], 0);
      for (const int source : sources)
        EXPECT_EQ(flow.source_side()[static_cast<size_t>(source)], 1);
    }
  }
}

TEST(MaxFlow, SendsNoMoreThanItIsAskedTo) {
  SupportGraph graph;
  graph.nodes = 3;
  graph.edges = {{0, 1, 5}, {1, 2, 3}};
  MaxFlow flow(graph);

  EXPECT_DOUBLE_EQ(flow.Send({0}, 2, 2), 2);
  EXPECT_DOUBLE_EQ(flow.Send({0}, 2, 9), 3);
}

}  // namespace
}  // namespace traverse
