#include "engine/weller/steps/point_reduction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/support/problems/instances.h"
#include "tests/support/problems/random_plan.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Figure 3.6: a contour with close points on its lower side, and the rasters of its island.
std::vector<IslandPaths> Figure36() {
  return {
      {{MakeContour({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {10, 0}, {10, 6}, {9, 6}, {0, 6}})},
       {MakeOpenPath({1.2, 1}, {8.8, 5}), MakeOpenPath({0.9, 1}, {0.5, 5})}}};
}

// Figure 3.5 (a): one island with two holes, one without.
TEST(AnalyzeIslands, SuppressesTheOuterContourOfAnIslandWithInnerOnes) {
  const Plan plan = SequentialPlan(
      {{{MakeContour({{0, 0}, {20, 0}, {20, 9}}), MakeContour({{3, 3}}), MakeContour({{12, 3}})},
        {}},
       {{MakeContour({{30, 0}, {34, 0}, {34, 4}})}, {}}});

  const IslandAnalysis analysis = AnalyzeIslands(IslandsOf(plan), {0, 1, 2, 3});

  EXPECT_THAT(analysis.kept, ElementsAre(1, 2, 3));
  EXPECT_THAT(analysis.suppressed, ElementsAre(0));
}

TEST(AnalyzeIslands, KeepsAnOuterContourWhoseInnerOnesAreElsewhere) {
  const Plan plan = SequentialPlan({{{MakeContour({{0, 0}}), MakeContour({{1, 1}})}, {}}});

  EXPECT_THAT(AnalyzeIslands(IslandsOf(plan), {0}).kept, ElementsAre(0));
  EXPECT_THAT(AnalyzeIslands(IslandsOf(plan), {1}).kept, ElementsAre(1));
}

TEST(AnalyzeIslands, SuppressesNothingWithoutIslands) {
  const IslandAnalysis analysis = AnalyzeIslands(IslandsOf(testing::FlatPlan(3)), {0, 1, 2});

  EXPECT_THAT(analysis.kept, ElementsAre(0, 1, 2));
  EXPECT_THAT(analysis.suppressed, IsEmpty());
}

TEST(SpacedPoints, DropsPointsNearTheLastOneKept) {
  const Path contour = Figure36()[0].contours[0];

  EXPECT_THAT(SpacedPoints(contour, 2.5), ElementsAre(0, 3, 5, 6, 8));
  EXPECT_THAT(SpacedPoints(contour, 2), ElementsAre(0, 2, 4, 5, 6, 8));  // 2 is not nearer than 2
  EXPECT_THAT(SpacedPoints(contour, 0), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(SpacedPoints(contour, 1000), ElementsAre(0));
}

TEST(SpacedPoints, StaysWithinTheEntriesAllowed) {
  Path contour = Figure36()[0].contours[0];
  contour.allowed = {7, 6, 1};

  EXPECT_THAT(SpacedPoints(contour, 2.5), ElementsAre(7, 1));
}

TEST(NearRasterPoints, IsTheNearestVertexOfEachRasterEnd) {
  const Plan plan = SequentialPlan(Figure36());

  // (1.2, 1) and (0.9, 1) are nearest to vertex 1, (8.8, 5) to 7, (0.5, 5) to 8.
  EXPECT_THAT(NearRasterPoints(plan, IslandsOf(plan), 0, 2.5), ElementsAre(1, 7, 8));
}

TEST(NearRasterPoints, AreSpacedPointsWithoutRasters) {
  const Plan plan = testing::AnyOrderPlan({Figure36()[0].contours[0]});

  EXPECT_THAT(NearRasterPoints(plan, IslandsOf(plan), 0, 2.5), ElementsAre(0, 3, 5, 6, 8));
}

TEST(BoxCenterPoint, IsTheMiddleOfTheExtremes) {
  EXPECT_EQ(BoxCenterPoint(Figure36()[0].contours[0]), (Point{5, 3}));
}

TEST(PointReduction, LeavesSubsetsOfTheEntries) {
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(absl::StrCat("seed ", seed));
    const Plan plan =
        testing::RandomPlan(seed, {.min_paths = 1, .max_paths = 12, .max_vertices = 20});
    const IslandLayout layout = IslandsOf(plan);

    for (int p = 0; p < static_cast<int>(plan.paths.size()); ++p) {
      const Path& path = plan.paths[size_t(p)];
      if (path.kind != Path::Kind::kContour) continue;
      std::vector<int> entries = EntryVertices(path);
      std::sort(entries.begin(), entries.end());
      for (std::vector<int> reduced :
           {SpacedPoints(path, 25), NearRasterPoints(plan, layout, p, 25)}) {
        std::sort(reduced.begin(), reduced.end());
        EXPECT_FALSE(reduced.empty());
        EXPECT_TRUE(std::includes(entries.begin(), entries.end(), reduced.begin(), reduced.end()));
      }
      for (const Representation representation :
           {Representation::kSpacedPoints, Representation::kNearRasterPoints,
            Representation::kBoxCenter}) {
        EXPECT_FALSE(RepresentativePoints(plan, layout, p, representation, 2.5).empty());
      }
    }
  }
}

}  // namespace
}  // namespace traverse
