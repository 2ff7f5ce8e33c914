#include "engine/cost/travel_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

CostSpec PrinterCost() {
  CostSpec spec;
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = 100;
  spec.accel_mm_s2 = 1000;
  spec.retraction_seconds = 0.5;
  spec.retraction_threshold_mm = 2;
  return spec;
}

TEST(TravelCost, IsTheLength) { EXPECT_EQ(TravelCost({})({0, 0}, {3, 4}), 5); }

TEST(TravelCost, IsTheTimeOfATrapezoidAndARetraction) {
  const TravelCost cost(PrinterCost());

  // 10 mm to reach the speed and to stop again: 0.2 s, and 0.1 s for each further 10 mm.
  EXPECT_DOUBLE_EQ(cost.OfLength(10), 0.2 + 0.5);
  EXPECT_DOUBLE_EQ(cost.OfLength(30), 0.4 + 0.5);
  EXPECT_DOUBLE_EQ(cost.OfLength(0.1), 2 * std::sqrt(0.1 / 1000));
  EXPECT_EQ(cost.OfLength(0), 0);
}

TEST(TravelCost, IsThatOfTheOracleAndNeverFalls) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const TravelCost cost(RandomCost(rng));
    double before = 0;
    for (double length = 0; length < 200; length += rng.Unit()) {
      EXPECT_NEAR(cost.OfLength(length), MoveCost(cost.spec(), {0, 0}, {length, 0}), 1e-9);
      EXPECT_GE(cost.OfLength(length), before);
      before = cost.OfLength(length);
    }
  }
}

TEST(TravelCost, KnowsTheLongestMoveWithinACost) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    const TravelCost cost(RandomCost(rng));
    for (int i = 0; i < 50; ++i) {
      const double limit = cost.OfLength(rng.Unit() * 100) * rng.Unit() * 2;

      const double longest = cost.LongestWithin(limit);

      EXPECT_LE(cost.OfLength(longest * (1 - 1e-9)), limit + 1e-9);
      EXPECT_GE(cost.OfLength(longest * (1 + 1e-9) + 1e-9), limit - 1e-9);
    }
  }
}

TEST(TravelCost, TheLongestMoveJustBelowARetractionIsTheThreshold) {
  const TravelCost cost(PrinterCost());

  EXPECT_DOUBLE_EQ(cost.LongestWithin(cost.OfLength(2) + 0.4), 2);
  EXPECT_DOUBLE_EQ(cost.LongestWithin(cost.OfLength(30)), 30);
  EXPECT_EQ(cost.LongestWithin(std::numeric_limits<double>::infinity()),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace traverse
