#include "engine/weller/framework_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/validator.h"
#include "engine/weller/steps/raster_route.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::OwnedProblem;

constexpr Representation kAll[] = {Representation::kSpacedPoints, Representation::kNearRasterPoints,
                                   Representation::kBoxCenter};

FrameworkResult Search(const OwnedProblem& owned, Representation representation,
                       int diversifications) {
  FrameworkOptions options;
  options.representation = representation;
  options.tabu.diversifications = diversifications;
  Budget budget;
  return SearchFramework(owned.problem, *AsClassicalLayer(owned.plan()), GivenRoute(owned.plan()),
                         options, budget);
}

TEST(SearchFramework, FindsValidRoutesWithIslandsTogether) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(
        seed, {.shape = testing::PlanShape::kSequential, .max_paths = 20, .max_vertices = 12});
    for (const Representation representation : kAll) {
      const FrameworkResult result = Search(owned, representation, 5);

      ASSERT_OK(ValidateRoute(owned.plan(), result.route));
      const size_t contours = AsClassicalLayer(owned.plan())->contours.size();
      const Route rasters(result.route.begin() + static_cast<std::ptrdiff_t>(contours),
                          result.route.end());
      EXPECT_TRUE(KeepsIslandsTogether(IslandsOf(owned.plan()), rasters));
    }
  }
}

// A row of islands: any good route goes along the row and back, 4 mm from island to island.
TEST(SearchFramework, SolvesARowOfIslands) {
  const OwnedProblem owned(SequentialPlan(testing::SquareGrid(10, 1)));

  for (const Representation representation : kAll) {
    const FrameworkResult result = Search(owned, representation, 100);

    EXPECT_EQ(result.penalized_contour_links, 0);
    EXPECT_EQ(result.penalized_raster_links, 0);
    EXPECT_LT(RouteCost(owned.problem, result.route), 2 * 9 * 4);
  }
}

TEST(SearchFramework, CountsWhatEachReductionLeaves) {
  // A plate of 20 mm with four holes and three rasters.
  const OwnedProblem owned(SequentialPlan(testing::PlateWithHoles()));

  const ReductionCounts points = Search(owned, Representation::kNearRasterPoints, 5).points;

  const auto contours = AsClassicalLayer(owned.plan())->contours;
  int entries = 0;
  for (const int contour : contours) {
    entries += static_cast<int>(owned.plan().paths[size_t(contour)].points.size());
  }
  EXPECT_EQ(points.entries, entries);
  EXPECT_EQ(points.island_analysis, entries - 4);  // the outline has four vertices
  EXPECT_EQ(points.box_center, 4);
  EXPECT_GE(points.near_raster, 4);
  EXPECT_LE(points.near_raster, points.island_analysis);
  EXPECT_LE(points.spaced, points.entries);
  EXPECT_LE(points.visible, points.spaced);
}

TEST(SearchFramework, OfALayerWithoutContoursOrRasters) {
  const OwnedProblem contours(testing::FlatPlan(5));
  const OwnedProblem rasters(
      SequentialPlan({{{}, {MakeOpenPath({5, 0}, {1, 0}), MakeOpenPath({9, 0}, {6, 0})}}}));
  const OwnedProblem empty{Plan{}};

  EXPECT_DOUBLE_EQ(
      RouteCost(contours.problem, Search(contours, Representation::kBoxCenter, 20).route), 4);
  EXPECT_DOUBLE_EQ(
      RouteCost(rasters.problem, Search(rasters, Representation::kBoxCenter, 20).route), 2);
  EXPECT_TRUE(Search(empty, Representation::kBoxCenter, 20).route.empty());
}

TEST(SearchAnyPlan, FindsValidRoutesOnAnyPlan) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(seed, {.max_paths = 15, .max_vertices = 12});
    const Route given = GivenRoute(owned.plan());
    for (const Representation representation : kAll) {
      FrameworkOptions options;
      options.representation = representation;
      options.tabu.diversifications = 5;
      Budget budget;

      const Route route = SearchAnyPlan(owned.problem, given, options, budget);

      EXPECT_OK(ValidateRoute(owned.plan(), route));
    }
  }
}

}  // namespace
}  // namespace traverse
