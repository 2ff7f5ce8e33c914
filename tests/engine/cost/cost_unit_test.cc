#include "engine/cost/cost_unit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/cost/travel_cost.h"

namespace traverse {
namespace {

Plan TwoDots(double apart_mm) {
  return SequentialPlan({{{MakeContour({{0, 0}}), MakeContour({{apart_mm, 0}})}, {}}});
}

// A search of lengths is twice as fast as one of times.
TEST(CostUnit, LeavesLengthsAsTheyAreUpToThirtyMetres) {
  for (const double apart_mm : {0.2, 200.0, 20'000.0, 30'000.0}) {
    const Plan plan = TwoDots(apart_mm);
    const LayerProblem problem{&plan, {0, 0}, std::nullopt, CostSpec(), 1};

    EXPECT_EQ(CostUnit(problem.cost, {&problem}), 1) << apart_mm;
  }
}

TEST(CostUnit, BringsOtherCostsToTheOrderOfOrdinaryOnes) {
  for (const double apart_mm : {1e-6, 1e-3, 1e5, 1e6}) {
    SCOPED_TRACE(apart_mm);
    const Plan plan = TwoDots(apart_mm);
    const LayerProblem problem{&plan, {0, 0}, std::nullopt, CostSpec(), 1};

    const double unit = CostUnit(problem.cost, {&problem});

    EXPECT_EQ(std::log2(unit), std::round(std::log2(unit)));
    const double cost = TravelCost(InUnit(problem.cost, unit))({0, 0}, {apart_mm, 0});
    EXPECT_DOUBLE_EQ(cost, unit * apart_mm);
    EXPECT_GT(cost, 32);
    EXPECT_LT(cost, 256);
  }
}

}  // namespace
}  // namespace traverse
