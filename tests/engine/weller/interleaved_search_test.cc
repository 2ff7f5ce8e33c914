#include "engine/weller/interleaved_search.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/cost/route_cost.h"
#include "engine/strategy/registry.h"
#include "engine/validator.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::OwnedProblem;
using testing::PlanShape;

TEST(AsInterleavedLayer, KnowsItFromOtherPlans) {
  EXPECT_EQ(AsInterleavedLayer(InterleavedPlan(testing::SquareGrid(3, 2)))->islands.size(), 6u);
  EXPECT_EQ(AsInterleavedLayer(InterleavedPlan(testing::PlateWithHoles()))->islands.size(), 1u);
  EXPECT_FALSE(AsInterleavedLayer(SequentialPlan(testing::PlateWithHoles())).has_value());
  EXPECT_FALSE(AsInterleavedLayer(testing::FlatPlan(3)).has_value());
  EXPECT_FALSE(AsInterleavedLayer(Plan()).has_value());
  Plan ordered = InterleavedPlan(testing::SquareGrid(2, 1));
  ordered.nodes[0].before = {{0, 1}};
  EXPECT_FALSE(AsInterleavedLayer(ordered).has_value());
}

TEST(SearchInterleaved, FindsValidRoutes) {
  for (uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = testing::RandomProblem(
        seed, {.shape = PlanShape::kInterleaved, .min_paths = 1, .max_paths = 20});
    const auto layer = AsInterleavedLayer(owned.plan());
    ASSERT_TRUE(layer.has_value());
    for (const auto representation :
         {Representation::kSpacedPoints, Representation::kNearRasterPoints,
          Representation::kBoxCenter}) {
      FrameworkOptions options;
      options.representation = representation;
      options.tabu.diversifications = 5;
      Budget budget;

      const FrameworkResult found = SearchInterleaved(owned.problem, *layer, options, budget);

      ASSERT_OK(ValidateRoute(owned.plan(), found.route));
    }
  }
}

// A row of islands of one contour and one raster: along the row, 3.1 mm or so from island to
// island.
TEST(SearchInterleaved, GoesAlongARow) {
  const OwnedProblem owned(InterleavedPlan(testing::SquareGrid(10, 1)));
  FrameworkOptions options;
  options.tabu.diversifications = 100;
  Budget budget;

  const FrameworkResult found =
      SearchInterleaved(owned.problem, *AsInterleavedLayer(owned.plan()), options, budget);

  EXPECT_EQ(found.penalized_contour_links, 0);
  for (size_t k = 0; k < found.route.size(); ++k) {
    EXPECT_EQ(found.route[k].path, static_cast<int>(k));
  }
  EXPECT_EQ(found.points.entries, 40);
  EXPECT_GT(found.points.visible, 0);
}

// What was ni2opt's route under the framework's name.
TEST(SearchInterleaved, IsWhatExactAndTabuDo) {
  const OwnedProblem owned(InterleavedPlan(testing::SquareGrid(3, 2)));
  Budget budget;

  const Solution milp = (*MakeStrategy("exact", {{"model", "framework"}, {"start", "none"}}))
                            ->Solve(owned.problem, budget);
  const Solution tabu = (*MakeStrategy("tabu", {{"thesis", "true"}, {"diversifications", "50"}}))
                            ->Solve(owned.problem, budget);

  EXPECT_EQ(milp.statistics.at("framework"), 1);
  EXPECT_EQ(milp.statistics.at("contours_programmes"), 7);  // of islands, and within each
  EXPECT_EQ(milp.statistics.at("rasters_programmes"), 6);
  EXPECT_OK(ValidateRoute(owned.plan(), milp.route));
  EXPECT_GT(tabu.statistics.at("points_vp"), 0);
  EXPECT_OK(ValidateRoute(owned.plan(), tabu.route));
}

}  // namespace
}  // namespace traverse
