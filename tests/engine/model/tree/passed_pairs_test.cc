#include "engine/model/tree/passed_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAreArray;

PlanNode NodeOf(int children, std::vector<std::pair<int, int>> before) {
  PlanNode node{PlanNode::Kind::kAnyOrder, 0, {}, std::move(before)};
  node.children.resize(static_cast<size_t>(children));
  std::iota(node.children.begin(), node.children.end(), 1);
  return node;
}

TEST(PassedPairs, GoThroughChildrenWithoutPaths) {
  const PlanNode node = NodeOf(5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}});

  EXPECT_THAT(*PassedPairs(node, {true, false, false, true, true}),
              ElementsAre(Pair(0, 3), Pair(3, 4)));
  EXPECT_THAT(*PassedPairs(NodeOf(3, {}), {true, true, true}), IsEmpty());
}

TEST(PassedPairs, TellNothingTwice) {
  const PlanNode node = NodeOf(4, {{0, 3}, {0, 3}, {0, 1}, {0, 2}, {1, 3}, {2, 3}});

  EXPECT_THAT(*PassedPairs(node, {true, false, false, true}), ElementsAre(Pair(0, 3)));
}

TEST(PassedPairs, AreThoseOfTheClosure) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const int n = rng.Between(1, 9);
    const auto size = static_cast<size_t>(n);
    std::vector<bool> has_paths;
    for (int i = 0; i < n; ++i) has_paths.push_back(rng.Below(2) == 0);
    PlanNode node = NodeOf(n, {});
    std::vector<std::vector<char>> reached(size, std::vector<char>(size));
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        if (rng.Below(3) != 0) continue;
        node.before.emplace_back(i, j);
        reached[size_t(i)][size_t(j)] = 1;
      }
    }
    for (size_t k = 0; k < size; ++k) {
      for (size_t i = 0; i < size && !has_paths[k]; ++i) {
        for (size_t j = 0; j < size; ++j) {
          if (reached[i][k] && reached[k][j]) reached[i][j] = 1;
        }
      }
    }
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const bool both = has_paths[size_t(i)] && has_paths[size_t(j)];
        if (both && reached[size_t(i)][size_t(j)]) expected.emplace_back(i, j);
      }
    }

    EXPECT_THAT(*PassedPairs(node, has_paths), UnorderedElementsAreArray(expected));
  }
}

// `k` children before an empty one, and that before as many others.
PlanNode Barrier(int k) {
  PlanNode node = NodeOf(2 * k + 1, {});
  for (int i = 0; i < k; ++i) {
    node.before.emplace_back(i, k);
    node.before.emplace_back(k, k + 1 + i);
  }
  return node;
}

std::vector<bool> AllBut(int empty, int children) {
  std::vector<bool> has_paths(static_cast<size_t>(children), true);
  has_paths[static_cast<size_t>(empty)] = false;
  return has_paths;
}

TEST(PassedPairs, OfASmallBarrierAreAllThereAre) {
  EXPECT_EQ(PassedPairs(Barrier(100), AllBut(100, 201))->size(), 10'000u);
}

// What a stranger may send in a message of a few MB: a million children, half of them before an
// empty one, and that before the others. All pairs would be 250,000,000,000.
TEST(PassedPairs, ThatMultiplyAreGivenUp) {
  for (const int k : {1000, 10'000, 500'000}) {
    EXPECT_EQ(PassedPairs(Barrier(k), AllBut(k, 2 * k + 1)), std::nullopt) << k;
  }
}

// Nor is much time lost on ways that lead nowhere: through a chain of empty children.
TEST(PassedPairs, ThroughLongChainsAreGivenUp) {
  constexpr int kChain = 20'000;
  PlanNode node = NodeOf(2 * kChain, {});
  std::vector<bool> has_paths(2 * kChain);
  for (int i = 0; i < kChain; ++i) {
    has_paths[size_t(i)] = true;
    node.before.emplace_back(i, kChain);
    if (i > 0) node.before.emplace_back(kChain + i - 1, kChain + i);
  }

  EXPECT_EQ(PassedPairs(node, has_paths), std::nullopt);
}

}  // namespace
}  // namespace traverse
