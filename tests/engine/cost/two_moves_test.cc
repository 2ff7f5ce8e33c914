// engine/cost/two_moves.h

#include "engine/cost/two_moves.h"

#include <gtest/gtest.h>

#include <limits>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "tests/support/problems/walled_problem.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TwoMoves RandomMoves(Rng& rng) {
  const auto point = [&rng] { return Point{100 * rng.Unit(), 100 * rng.Unit()}; };
  TwoMoves moves{point(), point(), point(), {}};
  if (rng.Below(4) != 0) moves.d = point();
  return moves;
}

double WholeCost(const TwoMoves& moves, const TravelCost& cost) {
  return cost(moves.a, moves.b) + (moves.d ? cost(moves.c, *moves.d) : 0);
}

TEST(TwoMoves, CostWhatTheyCostAsLongAsThatIsAskedFor) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const WalledProblem walled = RandomWalledProblem(seed, {.max_paths = 8}, seed % 2 == 0);
    const TravelCost cost(walled.problem());
    Rng rng(seed);
    for (int i = 0; i < 50; ++i) {
      const TwoMoves moves = RandomMoves(rng);
      const double whole = WholeCost(moves, cost);

      EXPECT_EQ(moves.CostWithin(std::numeric_limits<double>::infinity(), cost), whole);
      EXPECT_EQ(moves.CostWithin(whole, cost), whole);
      const double most = 2 * rng.Unit() * whole;
      const double answer = moves.CostWithin(most, cost);
      if (whole <= most) {
        EXPECT_EQ(answer, whole);
      } else {
        EXPECT_GT(answer, most);
        EXPECT_LE(answer, whole * (1 + 1e-9));
      }
    }
  }
}

TEST(TwoMoves, AskNoWallsForWhatIsTooDearWithoutThem) {
  const WalledProblem walled = RandomWalledProblem(1);
  const TravelCost cost(walled.problem());
  const TwoMoves moves{{0, 0}, {90, 90}, {5, 90}, Point{90, 5}};
  const double least = moves.Least(cost);

  EXPECT_EQ(moves.CostWithin(least / 2, cost), least);

  EXPECT_EQ(walled.cost->work(), 0);
}

}  // namespace
}  // namespace traverse
