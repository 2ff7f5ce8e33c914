#include "engine/souza/block_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/base/tolerances.h"
#include "engine/model/route.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/problems/walled_problem.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using namespace traverse::testing;  // NOLINT

const Precedence kFree;

Block BlockAt(double enter_x, double exit_x, int slot, bool reversible) {
  return Block{{enter_x, 0}, {exit_x, 0}, slot, reversible};
}

TEST(BlockLine, ReversesAStretchWithItsBlocksBackwards) {
  BlockLine line((TravelCost({})));
  line.Load({0, 0}, Point{10, 0}, {BlockAt(8, 6, 0, true), BlockAt(4, 2, 1, true)}, kFree);
  EXPECT_DOUBLE_EQ(line.Cost(), 8 + 2 + 8);

  EXPECT_DOUBLE_EQ(line.ReversalDelta(0, 1), 2 + 2 + 2 - 18);
  line.Reverse(0, 1);

  EXPECT_DOUBLE_EQ(line.Cost(), 6);
  EXPECT_THAT(line.slots(), ElementsAre(1, 0));
  EXPECT_THAT(line.reversed(), ElementsAre(1, 1));
}

TEST(BlockLine, KeepsTheDirectionOfBlocksThatHaveOne) {
  BlockLine line((TravelCost({})));
  line.Load({0, 0}, std::nullopt, {BlockAt(8, 6, 0, false), BlockAt(4, 2, 1, true)}, kFree);

  EXPECT_DOUBLE_EQ(line.ReversalDelta(0, 1), (2 + 4) - (8 + 2));
  line.Reverse(0, 1);

  EXPECT_DOUBLE_EQ(line.Cost(), 2 + 4);
  EXPECT_THAT(line.reversed(), ElementsAre(1, 0));
}

struct RandomLine {
  Plan plan;
  std::vector<Block> blocks;
  Point from;
  std::optional<Point> to;
  TravelCost cost;
};

// Blocks of every kind; the precedence is that of a random flat plan.
RandomLine MakeRandomLine(uint64_t seed, bool with_precedence) {
  Rng rng(seed);
  const auto point = [&] { return Point{rng.Unit() * 50, rng.Unit() * 50}; };
  RandomPlanOptions options;
  options.shape = PlanShape::kFlatBefore;
  options.min_paths = 2;
  options.max_paths = 12;
  RandomLine line{RandomPlan(seed, options), {}, point(), {}, TravelCost(RandomCost(rng))};
  if (!with_precedence) line.plan.nodes[0].before.clear();
  if (rng.Below(2) == 0) line.to = point();
  const bool symmetric = rng.Below(3) == 0;
  // In the order given, which keeps the pairs.
  for (const Visit& visit : GivenRoute(line.plan)) {
    const Point enter = point();
    const bool is_point = rng.Below(3) == 0;
    line.blocks.push_back(
        Block{enter, is_point ? enter : point(), visit.path, symmetric || rng.Below(2) == 0});
  }
  return line;
}

TEST(BlockLine, DeltaEqualsRecomputedCost) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const RandomLine random = MakeRandomLine(seed, false);
    Rng rng(seed);
    BlockLine line(random.cost);
    line.Load(random.from, random.to, random.blocks, kFree);

    for (int step = 0; step < 20; ++step) {
      const int first = rng.Between(0, line.size() - 1);
      const int last = rng.Between(first, line.size() - 1);
      const double before = line.Cost();
      const double delta = line.ReversalDelta(first, last);
      line.Reverse(first, last);
      EXPECT_NEAR(line.Cost(), before + delta, kCostTolerance);
    }
  }
}

TEST(BlockLine, ReversingTwiceRestoresTheLine) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const RandomLine random = MakeRandomLine(seed, false);
    BlockLine line(random.cost);
    line.Load(random.from, random.to, random.blocks, kFree);
    const double before = line.Cost();
    const std::vector<int> slots(line.slots().begin(), line.slots().end());

    line.Reverse(0, line.size() - 1);
    line.Reverse(0, line.size() - 1);

    EXPECT_EQ(line.Cost(), before);
    EXPECT_TRUE(std::equal(slots.begin(), slots.end(), line.slots().begin()));
    EXPECT_TRUE(std::all_of(line.reversed().begin(), line.reversed().end(),
                            [](char reversed) { return reversed == 0; }));
  }
}

bool Keeps(const std::vector<std::pair<int, int>>& before, absl::Span<const int> slots) {
  return std::all_of(before.begin(), before.end(), [&](const std::pair<int, int>& pair) {
    return std::find(slots.begin(), slots.end(), pair.first) <
           std::find(slots.begin(), slots.end(), pair.second);
  });
}

// From each block on, and carried out one after the other.
void ExpectTheBestReversals(const RandomLine& random, const TravelCost& cost) {
  const PlanTree tree(random.plan);
  const auto& before = random.plan.nodes[0].before;
  BlockLine line(cost);
  line.Load(random.from, random.to, random.blocks, tree.precedence(0));

  for (int first = 0; first < line.size(); ++first) {
    double least = -line.tolerance();
    for (int last = first; last < line.size(); ++last) {
      std::vector<int> slots(line.slots().begin(), line.slots().end());
      std::reverse(slots.begin() + first, slots.begin() + last + 1);
      if (Keeps(before, slots)) least = std::min(least, line.ReversalDelta(first, last));
    }
    const BlockLine::Reversal best = line.BestReversalFrom(first, -line.tolerance());
    EXPECT_EQ(best.delta, least);
    if (best.last < 0) continue;
    EXPECT_EQ(line.ReversalDelta(first, best.last), least);
    line.Reverse(first, best.last);
    EXPECT_TRUE(Keeps(before, line.slots()));
  }
}

TEST(BlockLine, FindsTheBestReversalThatKeepsThePairs) {
  for (uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const RandomLine random = MakeRandomLine(seed, true);

    ExpectTheBestReversals(random, random.cost);
  }
}

TEST(BlockLine, FindsTheBestReversalAmongWalls) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled = RandomWalledProblem(seed, {.max_paths = 8}, seed % 2 == 0);

    ExpectTheBestReversals(MakeRandomLine(seed, true), TravelCost(walled.problem()));
  }
}

}  // namespace
}  // namespace traverse
