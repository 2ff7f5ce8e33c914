#include "engine/proof/tsp/tsp_cuts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"

namespace traverse {
namespace {

// Items with one port, with two ends, or with a choice of two or three.
PathTsp RandomItems(Rng& rng, int items) {
  PathTsp problem;
  for (int item = 0; item < items; ++item) {
    const bool two_ends = rng.Below(3) == 0;
    const int ports = two_ends ? 2 : rng.Between(1, 3);
    for (int p = 0; p < ports; ++p) {
      problem.item.push_back(item);
      problem.mate.push_back(problem.ports + (two_ends ? 1 - p : p));
    }
    problem.ports += ports;
  }
  return problem;
}

// The moves of a random path, and the ports it visits.
TspSolution RandomPath(const TspNodes& nodes, Rng& rng) {
  TspSolution path;
  path.ports.assign(static_cast<size_t>(nodes.start()), 0);
  std::vector<int> items;
  for (int item = 1; item < nodes.item_count(); ++item) items.push_back(item);
  for (size_t i = items.size(); i-- > 1;) {
    std::swap(items[i], items[rng.Below(static_cast<uint32_t>(i) + 1)]);
  }
  int at = nodes.start();
  const auto go = [&](int to) { path.moves.push_back({{std::min(at, to), std::max(at, to)}, 1}); };
  for (const int item : items) {
    const int size = nodes.size(item);
    const int entry = nodes.first(item) + static_cast<int>(rng.Below(static_cast<uint32_t>(size)));
    for (int p = nodes.first(item); p < nodes.first(item + 1); ++p) {
      path.ports[static_cast<size_t>(p)] = !nodes.HasChoice(item) || p == entry ? 1 : 0;
    }
    go(entry);
    at = nodes.mate(entry);
  }
  go(nodes.finish());
  return path;
}

// Adds `share` of `path` to `mix`.
void Add(const TspSolution& path, double share, TspSolution& mix) {
  mix.ports.resize(path.ports.size());
  for (size_t p = 0; p < path.ports.size(); ++p) mix.ports[p] += share * path.ports[p];
  for (const auto& in_path : path.moves) {
    const TspMove& move = in_path.first;
    const double x = in_path.second;
    const auto known = std::find_if(mix.moves.begin(), mix.moves.end(), [&](const auto& it) {
      return it.first.a == move.a && it.first.b == move.b;
    });
    if (known == mix.moves.end()) {
      mix.moves.push_back({move, share * x});
    } else {
      known->second += share * x;
    }
  }
}

double Value(const TspCut& cut, const TspNodes& nodes, const TspSolution& solution) {
  double sum = 0;
  for (const auto& [move, x] : solution.moves) sum += cut.Coefficient(nodes, move) * x;
  for (const auto& [port, coefficient] : cut.ports) {
    sum += coefficient * solution.ports[static_cast<size_t>(port)];
  }
  return sum;
}

// Whatever a programme's solution is, no cut may forbid a path.
TEST(ViolatedCuts, HoldForEveryPath) {
  int found = 0;
  int blossoms = 0;
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const PathTsp problem = RandomItems(rng, rng.Between(4, 9));
    const TspNodes nodes(problem);
    TspSolution solution = RandomPath(nodes, rng);
    for (auto& [move, x] : solution.moves) {
      const int a = static_cast<int>(rng.Below(static_cast<uint32_t>(nodes.start())));
      const int b = static_cast<int>(rng.Below(static_cast<uint32_t>(nodes.start())));
      if (nodes.CanJoin(a, b)) move = {std::min(a, b), std::max(a, b)};
      x = rng.Below(2) == 0 ? 1 : 0.5;
    }
    Budget budget;

    for (const TspCut& cut : ViolatedCuts(nodes, solution, 0.01, 100, budget)) {
      ++found;
      blossoms += cut.crosses ? 1 : 0;
      for (int path = 0; path < 100; ++path) {
        const double value = Value(cut, nodes, RandomPath(nodes, rng));
        ASSERT_GE(value, cut.lower);
        ASSERT_LE(value, cut.upper);
      }
    }
  }
  EXPECT_GT(found, 500);
  EXPECT_GT(blossoms, 5);
}

// Where the moves of each node add up, as in mixes of paths, a subtour says the same by the moves
// out of its side: what is missing there is twice what is too much within.
TEST(ByMovesOut, SaysTheSame) {
  int subtours = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const PathTsp problem = RandomItems(rng, rng.Between(4, 9));
    const TspNodes nodes(problem);
    TspSolution solution = RandomPath(nodes, rng);
    for (auto& [move, x] : solution.moves) x = rng.Below(2) == 0 ? 1 : 0.5;
    TspSolution mix;
    for (int path = 0; path < 4; ++path) Add(RandomPath(nodes, rng), 0.25, mix);
    Budget budget;

    for (const TspCut& cut : ViolatedCuts(nodes, solution, 0.01, 100, budget)) {
      if (cut.crosses) continue;
      ++subtours;
      const TspCut out = ByMovesOut(cut);
      EXPECT_NEAR(Value(out, nodes, mix) - out.lower, 2 * (cut.upper - Value(cut, nodes, mix)),
                  1e-9);
    }
  }
  EXPECT_GT(subtours, 100);
}

TEST(ViolatedCuts, NeverForbidMixesOfPaths) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const PathTsp problem = RandomItems(rng, 7);
    const TspNodes nodes(problem);
    TspSolution mix;
    for (int path = 0; path < 4; ++path) Add(RandomPath(nodes, rng), 0.25, mix);
    Budget budget;

    EXPECT_TRUE(ViolatedCuts(nodes, mix, 0.01, 100, budget).empty());
  }
}

// A ring of four items, each with two ports visited by half, that are joined in pairs: every port
// has all its moves, each item two, and no item is crossed. start - a b - c d - ... - finish.
TEST(ViolatedCuts, SeePortsThatTheirItemIsLeftFromElsewhere) {
  PathTsp problem;
  for (int item = 0; item < 4; ++item) {
    for (int p = 0; p < 2; ++p) {
      problem.item.push_back(item);
      problem.mate.push_back(problem.ports++);
    }
  }
  const TspNodes nodes(problem);
  TspSolution solution;
  solution.ports.assign(8, 0.5);
  for (int item = 0; item < 3; ++item) {
    solution.moves.push_back({{2 * item + 1, 2 * item + 2}, 1});
  }
  solution.moves.push_back({{0, nodes.start()}, 1});
  solution.moves.push_back({{7, nodes.finish()}, 1});
  Budget budget;

  const std::vector<TspCut> cuts = ViolatedCuts(nodes, solution, 0.01, 100, budget);

  ASSERT_FALSE(cuts.empty());
  for (const TspCut& cut : cuts) {
    const double value = Value(cut, nodes, solution);
    EXPECT_TRUE(value < cut.lower - 0.01 || value > cut.upper + 0.01) << value;
  }
}

}  // namespace
}  // namespace traverse
