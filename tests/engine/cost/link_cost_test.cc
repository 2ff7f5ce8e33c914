// What links cost, by hand.

#include "engine/cost/link_cost.h"

#include <gtest/gtest.h>

namespace traverse {
namespace {

// At 10 mm/s and 3 s a retraction of moves longer than 20 mm.
CostSpec Time() {
  CostSpec spec;
  spec.kind = CostSpec::Kind::kTime;
  spec.speed_mm_s = 10;
  spec.retraction_seconds = 3;
  spec.retraction_threshold_mm = 20;
  return spec;
}

class LinkCosts : public ::testing::Test {
 protected:
  LinkCosts() {
    plan_.paths = {MakeContour({{0, 0}, {40, 0}}), MakeOpenPath({0, 10}, {40, 10})};
    links_ = {PathLinks{{Departure{Point{0, 5}, {0.1, 0.4}}, Departure{{}, {0.2, 0.2}}}, {}},
              PathLinks{{}, {LinkSeconds{1, 2}}}};
    problem_.plan = &plan_;
    problem_.cost = Time();
    problem_.links = &links_;
    problem_.before.seconds = {0.5, 0.7};
  }

  Plan plan_;
  LayerLinks links_;
  LayerProblem problem_;
};

TEST_F(LinkCosts, AreOfDepartureMoveAndArrival) {
  ASSERT_TRUE(LinksFit(links_, plan_));
  const LinkCost cost(problem_);
  EXPECT_DOUBLE_EQ(cost.To(cost.Before(), Visit{0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(cost.To(cost.Before(), Visit{0, 1}), 0.7 + 4 + 3);
  // From the end of the wipe, without a retraction and with one.
  EXPECT_DOUBLE_EQ(cost.To(cost.After({0, 0}), Visit{1, 0}), 0.1 + 0.5 + 1);
  EXPECT_NEAR(cost.To(cost.After({0, 0}), Visit{1, 1}), 0.4 + 4.0311 + 3 + 2, 1e-4);
  EXPECT_DOUBLE_EQ(cost.To(cost.After({0, 1}), Visit{1, 1}), 0.2 + 1 + 1);
  // An open path is left at its other end.
  EXPECT_DOUBLE_EQ(cost.To(cost.After({1, 1}), Visit{0, 0}), 1);
}

TEST_F(LinkCosts, HaveNoSecondsWhereTheCostIsALength) {
  problem_.cost = CostSpec();
  const LinkCost cost(problem_);
  EXPECT_DOUBLE_EQ(cost.To(cost.After({0, 0}), Visit{1, 0}), 5);
  EXPECT_DOUBLE_EQ(LeastOf(problem_).seconds, -5);
}

// Of 0 to 0.3 s more for the contour and 1 s for the open path: 0.15 and 1.
TEST_F(LinkCosts, AreSearchedWithTheMiddleRetraction) {
  EXPECT_DOUBLE_EQ(SymmetricCost(Time(), links_).retraction_seconds, 3 + (0.15 + 1) / 2);
}

TEST_F(LinkCosts, AreSearchedWithItOnKnownMovesToo) {
  LayerWalls walls;
  walls.known = {KnownMove{0, 1, 2, false, true}, KnownMove{1, 0, 2, true, false}};
  const LayerWalls searched = SymmetricWalls(walls, 0.5);
  EXPECT_DOUBLE_EQ(searched.known[0].seconds, 2.5);
  EXPECT_DOUBLE_EQ(searched.known[1].seconds, 2);
}

TEST_F(LinkCosts, AreBoundedByTheLeast) {
  const LeastLinks least = LeastOf(problem_);
  EXPECT_TRUE(least.moved);
  EXPECT_DOUBLE_EQ(least.cost.retraction_seconds, 3);
  // 0.5 s from the start, 0.1 s from the contour unless that is last, 1 s to the open path; 5 mm
  // less, and perhaps a retraction.
  EXPECT_DOUBLE_EQ(least.seconds, 0.5 + 0.1 + 1 - 0.1 - 0.5 - 3);
}

TEST_F(LinkCosts, FitTheirPlan) {
  links_[0].departures.resize(1);
  EXPECT_FALSE(LinksFit(links_, plan_)) << "one place for two exits";
  links_[0].departures[0].from.reset();
  EXPECT_TRUE(LinksFit(links_, plan_));
  links_[1].arrivals = {LinkSeconds{2, 1}};
  EXPECT_FALSE(LinksFit(links_, plan_)) << "less with a retraction";
  links_.pop_back();
  EXPECT_FALSE(LinksFit(links_, plan_)) << "not for each path";
}

}  // namespace
}  // namespace traverse
