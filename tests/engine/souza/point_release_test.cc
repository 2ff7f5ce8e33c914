#include "engine/souza/point_release.h"

#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "engine/base/tolerances.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using namespace traverse::testing;  // NOLINT

TEST(PointRelease, MovesTheEntryBetweenItsNeighbors) {
  const OwnedProblem owned(AnyOrderPlan(
      {MakeContour({{1, 0}}), MakeContour({{2, 5}, {2, 1}, {2, -9}}), MakeContour({{3, 0}})}));
  const LayerView layer(owned.problem);
  SearchRoute route(layer, GivenRoute(owned.plan()));
  const double before = route.Cost();
  Budget budget;

  const double change = ReleasePoints(route, Released::kAll, budget);

  EXPECT_EQ(route.ToRoute(), (Route{{0, 0}, {1, 1}, {2, 0}}));
  EXPECT_NEAR(route.Cost(), before + change, kCostTolerance);
}

TEST(PointRelease, TurnsOpenPathsRoundAndWithThatAloneLeavesContours) {
  const OwnedProblem owned(
      AnyOrderPlan({MakeContour({{5, 5}, {1, 0}}), MakeOpenPath({9, 0}, {2, 0})}));
  const LayerView layer(owned.problem);
  SearchRoute directions(layer, GivenRoute(owned.plan()));
  SearchRoute all(layer, GivenRoute(owned.plan()));
  Budget budget;

  ReleasePoints(directions, Released::kOpenPaths, budget);
  ReleasePoints(all, Released::kAll, budget);

  EXPECT_EQ(directions.ToRoute(), (Route{{0, 0}, {1, 1}}));
  EXPECT_EQ(all.ToRoute(), (Route{{0, 1}, {1, 1}}));
}

TEST(PointRelease, KeepsToAllowedEntries) {
  const OwnedProblem owned(
      AnyOrderPlan({MakeContour({{5, 5}, {1, 0}}, {0}), MakeOpenPath({9, 0}, {2, 0}, true)}));
  const LayerView layer(owned.problem);
  SearchRoute route(layer, GivenRoute(owned.plan()));
  Budget budget;

  EXPECT_EQ(ReleasePoints(route, Released::kAll, budget), 0);
  EXPECT_EQ(route.ToRoute(), GivenRoute(owned.plan()));
}

TEST(PointRelease, DeltaEqualsRecomputedCost) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 10});
    const LayerView layer(owned.problem);
    SearchRoute route(layer, GivenRoute(owned.plan()));
    for (int position = 0; position < route.size(); ++position) {
      const int path = layer.table.path_of(route.entry(position));
      for (int e = layer.table.first(path); e < layer.table.first(path + 1); ++e) {
        const double before = route.Cost();
        const double delta = PointReleaseDelta(route, position, e);
        route.SetEntry(position, e);
        EXPECT_NEAR(route.Cost(), before + delta, kCostTolerance);
      }
    }
  }
}

TEST(PointRelease, EndsWhereNoEntryOfAnyVisitIsBetter) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const OwnedProblem owned = RandomProblem(seed, {.max_paths = 10});
    const LayerView layer(owned.problem);
    SearchRoute route(layer, GivenRoute(owned.plan()));
    const double before = route.Cost();
    Budget budget;

    const double change = ReleasePoints(route, Released::kAll, budget);

    EXPECT_NEAR(route.Cost(), before + change, kCostTolerance);
    for (int position = 0; position < route.size(); ++position) {
      const int path = layer.table.path_of(route.entry(position));
      for (int e = layer.table.first(path); e < layer.table.first(path + 1); ++e) {
        EXPECT_GE(PointReleaseDelta(route, position, e), -kImprovementTolerance);
      }
    }
  }
}

}  // namespace
}  // namespace traverse
