#include "engine/weller/steps/contour_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rng.h"
#include "engine/cost/route_cost.h"
#include "engine/weller/steps/point_reduction.h"
#include "tests/support/problems/brute_force.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;

Path SquareContour(Point corner, double side) {
  const auto [x, y] = corner;
  return MakeContour({{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}});
}

// Figure 3.5: island 0 is a plate with two holes, island 1 a plate with one, island 2 plain.
Plan Figure35() {
  return SequentialPlan(
      {{{SquareContour({0, 0}, 20), SquareContour({2, 2}, 4), SquareContour({14, 14}, 4)}, {}},
       {{SquareContour({30, 0}, 10), SquareContour({33, 3}, 4)}, {}},
       {{SquareContour({50, 0}, 5)}, {}}});
}

std::vector<SequencedContour> AtCenters(const Plan& plan, const std::vector<int>& paths) {
  std::vector<SequencedContour> sequence;
  for (const int path : paths) {
    sequence.push_back({path, BoxCenterPoint(plan.paths[size_t(path)])});
  }
  return sequence;
}

TEST(ReinsertOuterContours, PutsThemOnTheMovesThatReachTheirIslands) {
  const Plan plan = Figure35();

  const std::vector<int> order =
      ReinsertOuterContours(plan, IslandsOf(plan), {0, 3}, AtCenters(plan, {1, 2, 4, 5}), {0, 0},
                            TravelCost(CostSpec{}), 2.5);

  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4, 5));
}

// The route enters the first plate twice: from the start to hole 1 at (4, 4), and from the plain
// plate at (52.5, 2.5) to hole 2 at (16, 16). The corner (20, 20) on the second of these moves
// costs 36.91 + 5.66 - 38.92 = 3.65, the corner (0, 0) on the first one from (-10, 4) 10.77 + 5.66
// - 14 = 2.43, from (5, 4) 6.40 + 5.66 - 1 = 11.06.
TEST(ReinsertOuterContours, TakesTheCheapestOfSeveralMoves) {
  const Plan plan = Figure35();
  const auto order_from = [&](Point start) {
    return ReinsertOuterContours(plan, IslandsOf(plan), {0, 3}, AtCenters(plan, {1, 4, 5, 2}),
                                 start, TravelCost(CostSpec{}), 2.5);
  };

  EXPECT_THAT(order_from({-10, 4}), ElementsAre(0, 1, 3, 4, 5, 2));
  EXPECT_THAT(order_from({5, 4}), ElementsAre(1, 3, 4, 5, 0, 2));
}

TEST(ReinsertOuterContours, BringsEachBackOnce) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = testing::RandomPlan(
        seed, {.shape = testing::PlanShape::kSequential, .min_paths = 1, .max_paths = 20});
    const IslandLayout layout = IslandsOf(plan);
    const auto layer = AsClassicalLayer(plan);
    ASSERT_TRUE(layer.has_value());
    IslandAnalysis analysis = AnalyzeIslands(layout, layer->contours);
    Rng rng(seed);
    for (size_t i = analysis.kept.size(); i > 1; --i) {
      std::swap(analysis.kept[i - 1], analysis.kept[rng.Below(static_cast<uint32_t>(i))]);
    }

    const std::vector<int> order =
        ReinsertOuterContours(plan, layout, analysis.suppressed, AtCenters(plan, analysis.kept),
                              {0, 0}, TravelCost(CostSpec{}), 2.5);

    EXPECT_THAT(order, ::testing::UnorderedElementsAreArray(layer->contours));
    for (size_t k = 0; k < order.size(); ++k) {
      const auto& suppressed = analysis.suppressed;
      if (std::count(suppressed.begin(), suppressed.end(), order[k]) == 0) continue;
      ASSERT_LT(k + 1, order.size());
      EXPECT_EQ(layout.island_of[size_t(order[k])], layout.island_of[size_t(order[k + 1])]);
    }
  }
}

// Corners and middles of the sides, counterclockwise from the lower left corner.
Path SquareWithMiddles(Point corner, double side) {
  const auto [x, y] = corner;
  const double h = side / 2;
  return MakeContour({{x, y},
                      {x + h, y},
                      {x + side, y},
                      {x + side, y + h},
                      {x + side, y + side},
                      {x + h, y + side},
                      {x, y + side},
                      {x, y + h}});
}

// Figure 3.8: from the origin to a large square, on to a small one.
TEST(VisiblePointsAlong, KeepsWhatEitherNeighborSees) {
  const Plan plan =
      testing::AnyOrderPlan({SquareWithMiddles({10, -4}, 8), SquareWithMiddles({30, -2}, 4)});

  const auto visible = VisiblePointsAlong(plan, {0, 1}, {0, 0}, 2);

  // The origin sees the left side of the large square, the small square its right side. The
  // tangents narrow towards the small square and touch its far corners, so all of it is seen.
  ASSERT_EQ(visible.size(), 2u);
  EXPECT_THAT(visible[0], ElementsAre(0, 2, 3, 4, 6, 7));
  EXPECT_THAT(visible[1], ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
}

// From the origin into a plate with a hole and on to a square on the right: both contours are seen
// from the left and from the right.
TEST(VisiblePointsAlong, LooksPastAnEnclosedContour) {
  const Plan plan =
      testing::AnyOrderPlan({SquareWithMiddles({10, -10}, 20), SquareWithMiddles({16, -4}, 8),
                             SquareWithMiddles({90, -2}, 4)});

  const auto visible = VisiblePointsAlong(plan, {0, 1, 2}, {0, 0}, 2);

  ASSERT_EQ(visible.size(), 3u);
  EXPECT_THAT(visible[0], ElementsAre(0, 2, 3, 4, 6, 7));
  EXPECT_THAT(visible[1], ElementsAre(0, 2, 3, 4, 6, 7));
  EXPECT_EQ(visible[2].size(), 8u);
}

TEST(VisiblePointsAlong, LeavesSubsetsOfTheSpacedPoints) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan = testing::RandomPlan(seed, {.shape = testing::PlanShape::kFlatContours,
                                                 .min_paths = 1,
                                                 .max_paths = 10,
                                                 .max_vertices = 20});
    std::vector<int> order(plan.paths.size());
    std::iota(order.begin(), order.end(), 0);

    const auto visible = VisiblePointsAlong(plan, order, {50, 50}, 10);

    ASSERT_EQ(visible.size(), order.size());
    for (size_t k = 0; k < order.size(); ++k) {
      std::vector<int> spaced = SpacedPoints(plan.paths[k], 10);
      std::sort(spaced.begin(), spaced.end());
      EXPECT_FALSE(visible[k].empty());
      EXPECT_TRUE(
          std::includes(spaced.begin(), spaced.end(), visible[k].begin(), visible[k].end()));
    }
  }
}

TEST(ChooseContourPoints, EqualsBruteForce) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    Rng rng(seed);
    Plan plan = testing::RandomPlan(
        seed, {.shape = testing::PlanShape::kFlatContours, .min_paths = 1, .max_paths = 6});
    std::vector<int> order(plan.paths.size());
    std::iota(order.begin(), order.end(), 0);
    LayerProblem problem;
    problem.plan = &plan;
    problem.start = {50, 50};
    problem.cost = testing::RandomCost(rng);
    const auto vertices = VisiblePointsAlong(plan, order, problem.start, 10);

    const Route route =
        ChooseContourPoints(plan, order, vertices, problem.start, TravelCost(problem.cost));

    for (size_t k = 0; k < order.size(); ++k) {
      EXPECT_EQ(route[k].path, order[k]);
      EXPECT_THAT(vertices[k], ::testing::Contains(route[k].entry));
      plan.paths[k].allowed = vertices[k];
    }
    EXPECT_NEAR(RouteCost(problem, route), testing::BestEntries(problem, order).cost, 1e-9);
  }
}

TEST(ChooseContourPoints, OfNoContours) {
  EXPECT_TRUE(ChooseContourPoints(Plan{}, {}, {}, {0, 0}, TravelCost(CostSpec{})).empty());
}

}  // namespace
}  // namespace traverse
