#include "engine/weller/steps/raster_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace traverse {
namespace {

using ::testing::ElementsAre;

Plan TwoIslands() {
  const Path raster = MakeOpenPath({0, 0}, {1, 1});
  return SequentialPlan({{{MakeContour({{0, 0}})}, {raster, raster}}, {{}, {raster}}});
}

TEST(GroupRasters, IsByIsland) {
  const Plan plan = TwoIslands();

  const std::vector<RasterGroup> groups = GroupRasters(IslandsOf(plan), {3, 1, 2});

  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].island, 1);
  EXPECT_THAT(groups[0].rasters, ElementsAre(3));
  EXPECT_THAT(groups[1].rasters, ElementsAre(1, 2));
}

TEST(KeepsIslandsTogether, IsFalseOnlyForAReturn) {
  const IslandLayout layout = IslandsOf(TwoIslands());

  EXPECT_TRUE(KeepsIslandsTogether(layout, {}));
  EXPECT_TRUE(KeepsIslandsTogether(layout, {{2, 0}, {1, 1}, {3, 0}}));
  EXPECT_FALSE(KeepsIslandsTogether(layout, {{1, 0}, {3, 0}, {2, 0}}));
}

}  // namespace
}  // namespace traverse
