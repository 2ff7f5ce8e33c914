#include "engine/proof/tsp/tsp_relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/engine/proof/tsp/small_tsp.h"

namespace traverse {
namespace {

using Status = LinearProgram::Status;

constexpr double kRounding = 1e-6;
constexpr double kForbidden = 1e5;

// Solves with all moves, and with cuts until there are none left to add. What it came to with each.
std::vector<double> SolveWithCuts(TspRelaxation& relaxation, Budget& budget) {
  std::vector<double> values;
  do {
    EXPECT_EQ(relaxation.lp().SolveDual(budget), Status::kOptimal);
    values.push_back(relaxation.lp().value());
  } while (relaxation.Separate(1e-4, 50, budget) > 0);
  return values;
}

TEST(TspRelaxation, IsNeverAboveTheBestPathAndRisesWithCuts) {
  int cut = 0;
  int paths = 0;
  for (uint64_t seed = 1; seed <= 80; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const SmallTsp small = RandomTsp(seed, static_cast<int>(3 + seed % 4));
    const double best = BestTspCost(small);
    Budget budget;
    TspRelaxation relaxation(small.tsp);
    relaxation.SetStart(small.start, kForbidden);
    relaxation.AddMoves(AllMoves(relaxation.nodes()));

    const std::vector<double> values = SolveWithCuts(relaxation, budget);

    EXPECT_TRUE(std::is_sorted(values.begin(), values.end(),
                               [](double a, double b) { return a < b - kRounding; }));
    EXPECT_LE(values.back(), best + kRounding * (1 + best));
    EXPECT_LE(relaxation.lp().SafeBound(), best + kRounding * (1 + best));
    cut += relaxation.total_cuts() > 0 ? 1 : 0;
    const std::vector<int> path = relaxation.IntegralPath();
    if (path.empty()) continue;
    ++paths;
    EXPECT_NEAR(TspCostOf(small, path), values.back(), kRounding * (1 + best));
  }
  EXPECT_GT(cut, 20);
  EXPECT_GT(paths, 40);
}

// Moves that come in by their price do what all moves do.
TEST(TspRelaxation, PricingBringsInWhatIsMissing) {
  int priced = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const SmallTsp small = RandomTsp(seed, 6);
    Budget budget;
    TspRelaxation whole(small.tsp);
    whole.SetStart(small.start, kForbidden);
    whole.AddMoves(AllMoves(whole.nodes()));
    ASSERT_EQ(whole.lp().SolveDual(budget), Status::kOptimal);
    double missing = 0;
    EXPECT_EQ(whole.Price(1000, missing, budget), 0);
    EXPECT_EQ(missing, 0);
    const std::vector<int> firsts = FirstPorts(small.tsp);
    const auto exit = [&](int port) { return small.tsp.mate[static_cast<size_t>(port)]; };
    TspRelaxation part(small.tsp);
    part.SetStart(small.start, kForbidden);
    // Moves name the lower node first.
    std::vector<TspMove> first = {{firsts.front(), part.nodes().start()},
                                  {exit(firsts.back()), part.nodes().finish()}};
    for (size_t i = 0; i + 1 < firsts.size(); ++i) {
      first.push_back(
          {std::min(exit(firsts[i]), firsts[i + 1]), std::max(exit(firsts[i]), firsts[i + 1])});
    }
    part.AddMoves(first);
    ASSERT_EQ(part.lp().SolveDual(budget), Status::kOptimal);
    while (part.Price(5, missing, budget) > 0) {
      ++priced;
      EXPECT_LT(missing, 0);
      ASSERT_EQ(part.lp().SolvePrimal(budget), Status::kOptimal);
    }
    EXPECT_NEAR(part.lp().value(), whole.lp().value(), kRounding * (1 + whole.lp().value()));
  }
  EXPECT_GT(priced, 10);
}

// Every fifth move, so that there may be no path.
std::vector<TspMove> SomeMoves(const TspNodes& nodes) {
  const std::vector<TspMove> all = AllMoves(nodes);
  std::vector<TspMove> some;
  for (size_t i = 0; i < all.size(); i += 5) some.push_back(all[i]);
  return some;
}

// Brings moves in as long as there is no point and they may make one. Returns how often.
int MakeFeasible(TspRelaxation& relaxation, Budget& budget, Status& status) {
  int times = 0;
  status = relaxation.lp().SolveDual(budget);
  while (status == Status::kInfeasible) {
    const int added = relaxation.PriceInfeasible(5, budget);
    EXPECT_GE(added, 0);
    if (added <= 0) break;
    ++times;
    status = relaxation.lp().SolveDual(budget);
  }
  return times;
}

TEST(TspRelaxation, PricingMakesItFeasibleIfItCanBe) {
  int priced = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const SmallTsp small = RandomTsp(seed, 6);
    Budget budget;
    Status status = Status::kStopped;
    TspRelaxation can(small.tsp);
    can.SetStart(small.start, kForbidden);
    can.AddMoves(SomeMoves(can.nodes()));
    priced += MakeFeasible(can, budget, status);
    EXPECT_EQ(status, Status::kOptimal);

    // No move may lead to the finish.
    TspRelaxation cannot(small.tsp);
    cannot.SetStart(small.start, kForbidden);
    const int first = cannot.column_count();
    for (int port = 0; port < cannot.nodes().start(); ++port) {
      cannot.AddMoves({{port, cannot.nodes().finish()}});
    }
    for (int column = first; column < cannot.column_count(); ++column) cannot.Fix(column, false);
    cannot.AddMoves(SomeMoves(cannot.nodes()));
    MakeFeasible(cannot, budget, status);
    EXPECT_EQ(status, Status::kInfeasible);
  }
  EXPECT_GT(priced, 10);
}

// Whether two items follow each other is held in a row, which moves that come in later are part of.
TEST(TspRelaxation, HoldsPairsAmongMovesThatComeIn) {
  int dearer = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const SmallTsp small = RandomTsp(seed, 6);
    const double best = BestTspCost(small);
    const double rounding = kRounding * (1 + best);
    Budget budget;
    double least = kForbidden;
    for (const bool in : {false, true}) {
      SCOPED_TRACE(absl::StrCat("seed ", seed, in ? " in" : " out"));
      const TspRelaxation::ItemPair pair{2, 4};
      TspRelaxation whole(small.tsp);
      whole.SetStart(small.start, kForbidden);
      whole.AddMoves(AllMoves(whole.nodes()));
      ASSERT_EQ(whole.lp().SolveDual(budget), Status::kOptimal);
      const double free = whole.lp().value();
      whole.HoldPairs({{1, 3}, pair});
      whole.Fix(pair, in);
      whole.HoldPairs({pair});
      ASSERT_EQ(whole.lp().SolveDual(budget), Status::kOptimal);
      const double value = whole.lp().value();
      EXPECT_GE(value, free - rounding);
      dearer += value > free + rounding ? 1 : 0;

      TspRelaxation part(small.tsp);
      part.SetStart(small.start, kForbidden);
      part.AddMoves(SomeMoves(part.nodes()));
      part.HoldPairs({pair});
      part.Fix(pair, in);
      Status status = Status::kStopped;
      MakeFeasible(part, budget, status);
      ASSERT_EQ(status, Status::kOptimal);
      double missing = 0;
      while (part.Price(5, missing, budget) > 0) {
        ASSERT_EQ(part.lp().SolvePrimal(budget), Status::kOptimal);
      }
      EXPECT_NEAR(part.lp().value(), value, rounding);
      least = std::min(least, SolveWithCuts(whole, budget).back());
    }
    EXPECT_LE(least, best + rounding);  // the best path is in one of both
  }
  EXPECT_GT(dearer, 30);
}

// Solves from several starts begin so, whatever the last one had fixed.
TEST(TspRelaxation, AllowingAllFreesPairsAndColumns) {
  const SmallTsp small = RandomTsp(3, 6);
  const TspRelaxation::ItemPair pair{2, 4};
  Budget budget;
  TspRelaxation relaxation(small.tsp);
  relaxation.SetStart(small.start, kForbidden);
  relaxation.AddMoves(AllMoves(relaxation.nodes()));
  ASSERT_EQ(relaxation.lp().SolveDual(budget), Status::kOptimal);
  const double free = relaxation.lp().value();
  const int rows = relaxation.lp().row_count();
  relaxation.HoldPairs({pair});
  relaxation.Fix(pair, true);
  relaxation.Fix(relaxation.column_count() - 1, true);
  ASSERT_EQ(relaxation.lp().SolveDual(budget), Status::kOptimal);
  ASSERT_GT(relaxation.lp().value(), free + kRounding);

  relaxation.AllowAll();
  relaxation.Free(pair);  // is free already

  EXPECT_EQ(relaxation.lp().row_count(), rows);
  ASSERT_EQ(relaxation.lp().SolveDual(budget), Status::kOptimal);
  EXPECT_NEAR(relaxation.lp().value(), free, kRounding);
}

TEST(TspRelaxation, WhatIsLeftOutIsOfNoPathWithinTheGap) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const SmallTsp small = RandomTsp(seed, 6);
    const double best = BestTspCost(small);
    Budget budget;
    TspRelaxation relaxation(small.tsp);
    relaxation.SetStart(small.start, kForbidden);
    relaxation.AddMoves(AllMoves(relaxation.nodes()));
    const double bound = SolveWithCuts(relaxation, budget).back();

    relaxation.LeaveOutDear(best - bound + kRounding * (1 + best), budget);

    const double left = SolveWithCuts(relaxation, budget).back();
    EXPECT_LE(left, best + kRounding * (1 + best));
    relaxation.AllowAll();
    EXPECT_LE(SolveWithCuts(relaxation, budget).back(), left + kRounding * (1 + best));
  }
}

}  // namespace
}  // namespace traverse
