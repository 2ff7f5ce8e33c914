#include "engine/proof/programs/linear_program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"

namespace traverse {
namespace {

using Status = LinearProgram::Status;

TEST(LinearProgram, SolvesAndIsSolvedAgainAfterARow) {
  LinearProgram lp;
  Budget budget;
  const int x = lp.AddColumn(-1, 0, 10, {});
  const int y = lp.AddColumn(-2, 0, 10, {});
  LinearProgram::Entries sum;
  sum.Add(x, 1);
  sum.Add(y, 1);
  lp.AddRow(-LinearProgram::kInfinity, 12, sum);

  ASSERT_EQ(lp.SolveDual(budget), Status::kOptimal);
  EXPECT_NEAR(lp.value(), -22, 1e-9);
  EXPECT_NEAR(lp.SafeBound(), -22, 1e-9);

  LinearProgram::Entries only_y;
  only_y.Add(y, 1);
  const int limit = lp.AddRow(-LinearProgram::kInfinity, 4, only_y);
  ASSERT_EQ(lp.SolveDual(budget), Status::kOptimal);
  EXPECT_NEAR(lp.value(), -16, 1e-9);
  EXPECT_NEAR(lp.Primal(x), 8, 1e-9);

  lp.DeleteRows({limit});
  ASSERT_EQ(lp.SolveDual(budget), Status::kOptimal);
  EXPECT_NEAR(lp.value(), -22, 1e-9);
}

TEST(LinearProgram, ShowsThatThereIsNoPoint) {
  LinearProgram lp;
  Budget budget;
  LinearProgram::Entries sum;
  for (int j = 0; j < 3; ++j) sum.Add(lp.AddColumn(1, 0, 1, {}), 1);
  lp.AddRow(2, 2, sum);
  ASSERT_EQ(lp.SolveDual(budget), Status::kOptimal);

  lp.SetColumnBounds(0, 0, 0);
  lp.SetColumnBounds(1, 0, 0);

  EXPECT_EQ(lp.SolveDual(budget), Status::kInfeasible);
  EXPECT_TRUE(lp.IsSurelyInfeasible());
  // One column is missing: it is worth as much as its entry times the multiplier.
  const auto contradiction = lp.FindContradiction();
  ASSERT_TRUE(contradiction.has_value());
  ASSERT_EQ(contradiction->multipliers.size(), 1u);
  EXPECT_NEAR(contradiction->margin, std::abs(contradiction->multipliers[0]), 1e-5);
}

// Covering problems: whatever the number of iterations, the bound is below every feasible value.
TEST(LinearProgram, SafeBoundHoldsForAnyDuals) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    LinearProgram lp;
    Budget budget;
    for (int j = 0; j < 30; ++j) lp.AddColumn(1 + rng.Unit(), 0, 1, {});
    for (int i = 0; i < 20; ++i) {
      LinearProgram::Entries row;
      for (int j = 0; j < 30; ++j) {
        if (rng.Below(4) == 0) row.Add(j, 1);
      }
      if (!row.indices.empty()) lp.AddRow(1, static_cast<double>(row.indices.size()), row);
    }
    lp.SolveDual(budget, static_cast<int>(seed % 12));
    const double early = lp.SafeBound();
    ASSERT_EQ(lp.SolveDual(budget), Status::kOptimal);

    EXPECT_LE(early, lp.value() + 1e-7);
    EXPECT_NEAR(lp.SafeBound(), lp.value(), 1e-6);
  }
}

TEST(LinearProgram, SolvedAfreshItHasTheSameValue) {
  LinearProgram lp;
  Budget budget;
  LinearProgram::Entries sum;
  for (int j = 0; j < 4; ++j) sum.Add(lp.AddColumn(j + 1, 0, 1, {}), 1);
  lp.AddRow(2, 3, sum);
  ASSERT_EQ(lp.SolveDual(budget), Status::kOptimal);
  ASSERT_NEAR(lp.value(), 3, 1e-9);

  lp.SetBasis(std::vector<unsigned char>(5, 0));  // none at all
  EXPECT_EQ(lp.SolveAfresh(budget), Status::kOptimal);
  EXPECT_NEAR(lp.value(), 3, 1e-9);

  for (int j = 0; j < 3; ++j) lp.SetColumnBounds(j, 0, 0);
  EXPECT_EQ(lp.SolveAfresh(budget), Status::kInfeasible);
  EXPECT_TRUE(lp.IsSurelyInfeasible());
}

TEST(LinearProgram, StopsWhenTheBudgetIsCancelled) {
  LinearProgram lp;
  LinearProgram::Entries row;
  row.Add(lp.AddColumn(1, 0, 1, {}), 1);
  lp.AddRow(1, 1, row);
  CancelToken cancel;
  cancel.Cancel();
  Budget budget(&cancel);

  EXPECT_EQ(lp.SolveDual(budget), Status::kStopped);
}

}  // namespace
}  // namespace traverse
