// What the search by the cost of links asks; what it finds: tests/engine/schedule/links_test.cc.

#include "engine/search/link_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/cost/wall_cost.h"
#include "engine/model/links.h"
#include "engine/model/plan.h"
#include "engine/model/walls.h"
#include "engine/validator.h"
#include "tests/support/status_matchers.h"
#include "tests/support/step_clock.h"

namespace traverse {
namespace {

constexpr int kSide = 7;
constexpr size_t kVertices = 16;

// Rings on a grid, each a wall that travel leads around; half of them are dear to leave with a
// retraction.
class LinkSearch : public ::testing::Test {
 protected:
  LinkSearch() {
    plan_.nodes.resize(1);
    plan_.nodes[0].kind = PlanNode::Kind::kAnyOrder;
    for (int i = 0; i < kSide * kSide; ++i) AddRing({8.0 * (i % kSide), 8.0 * (i / kSide)});
    problem_.plan = &plan_;
    problem_.cost = {.kind = CostSpec::Kind::kTime,
                     .speed_mm_s = 150,
                     .accel_mm_s2 = 3000,
                     .retraction_seconds = 0.2,
                     .retraction_threshold_mm = 20,
                     .lift_seconds = 0.1,
                     .crossing_seconds = 0.3,
                     .wall_clearance_mm = 0.4};
    problem_.links = &links_;
  }

  void AddRing(Point center) {
    const auto i = static_cast<int>(plan_.paths.size());
    std::vector<Point> points;
    for (size_t k = 0; k < kVertices; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / kVertices;
      points.push_back({center.x + 3 * std::cos(angle), center.y + 3 * std::sin(angle)});
    }
    plan_.paths.push_back(MakeContour(points));
    walls_.walls.push_back({points, true, i});
    links_.push_back({{Departure{{}, {0.05, 0.2 + 0.1 * (i % 2)}}}, {}});
    plan_.nodes[0].children.push_back(i + 1);
    PlanNode leaf;
    leaf.path = i;
    plan_.nodes.push_back(leaf);
  }

  Plan plan_;
  LayerWalls walls_;
  LayerLinks links_;
  LayerProblem problem_;
};

// A detour around walls is worth a search, which is done once for a move that may be taken.
TEST_F(LinkSearch, AsksAboutWallsWhereTheyMatter) {
  const WallCost walls(walls_, plan_, problem_.cost);
  problem_.walls = &walls;
  const Route given = GivenRoute(plan_);
  const double cost = RouteCost(problem_, given);
  const int64_t before = walls.work();
  Budget budget;
  const Route found = ImproveLinks(problem_, given, LinkEffort::kSettle, budget);
  EXPECT_LT(RouteCost(problem_, found), 0.9 * cost);
  EXPECT_LT(walls.work() - before, 40'000 * kSide * kSide);
}

// Where no small change is a gain, several at once may be.
TEST_F(LinkSearch, KicksFindWhatNoSmallChangeDoes) {
  Rng rng(1);
  for (int i = 0; i < 400; ++i) AddRing({90 * rng.Unit(), 90 * rng.Unit()});
  problem_.cost.retraction_threshold_mm = 2;
  const Route given = GivenRoute(plan_);
  Budget budget;
  const Route settled = ImproveLinks(problem_, given, LinkEffort::kSettle, budget);
  const Route kicked = ImproveLinks(problem_, given, LinkEffort::kKick, budget);
  ASSERT_OK(ValidateRoute(plan_, kicked));
  EXPECT_LT(RouteCost(problem_, kicked), 0.98 * RouteCost(problem_, settled));
}

// No kick can gain anything where all is in one place, or the order is fixed.
TEST_F(LinkSearch, EndsWhereNothingCanBeGained) {
  Budget budget;
  plan_.nodes[0].kind = PlanNode::Kind::kInOrder;
  const Route given = GivenRoute(plan_);
  ASSERT_OK(ValidateRoute(plan_, ImproveLinks(problem_, given, LinkEffort::kKick, budget)));

  plan_.nodes[0].kind = PlanNode::Kind::kAnyOrder;
  for (Path& path : plan_.paths) path = MakeContour({{0, 0}});
  links_.assign(plan_.paths.size(), PathLinks());
  EXPECT_EQ(ImproveLinks(problem_, given, LinkEffort::kKick, budget).size(), given.size());
}

// A kick that is not finished is taken back.
TEST_F(LinkSearch, StopsWithNoWorseRouteWhileItKicks) {
  const Route given = GivenRoute(plan_);
  Budget endless;
  const Route settled = ImproveLinks(problem_, given, LinkEffort::kSettle, endless);
  for (int64_t steps = 100; steps < 10'000; steps *= 3) {
    const StepClock clock;
    Budget budget(nullptr, StepClock::At(steps), {}, &clock);
    const Route route = ImproveLinks(problem_, settled, LinkEffort::kKick, budget);
    ASSERT_OK(ValidateRoute(plan_, route));
    EXPECT_LE(RouteCost(problem_, route), RouteCost(problem_, settled) + 1e-9);
  }
}

// Each question about a wall may take long.
TEST_F(LinkSearch, StopsBetweenTwoQuestions) {
  const WallCost walls(walls_, plan_, problem_.cost);
  problem_.walls = &walls;
  const Route given = GivenRoute(plan_);
  CancelToken cancel;
  cancel.Cancel();
  Budget budget(&cancel, std::nullopt);
  EXPECT_EQ(ImproveLinks(problem_, given, LinkEffort::kKick, budget), given);
  EXPECT_EQ(walls.work(), 0);
}

}  // namespace
}  // namespace traverse
