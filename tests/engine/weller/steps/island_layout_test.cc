#include "engine/weller/steps/island_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/support/problems/instances.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(IslandsOf, FollowsTheBuildersOfThePlan) {
  const std::vector<IslandPaths> islands = {
      {{MakeContour({{0, 0}}), MakeContour({{1, 1}})}, {MakeOpenPath({2, 2}, {3, 3})}},
      {{MakeContour({{4, 4}})}, {}}};

  for (const Plan& plan : {SequentialPlan(islands), InterleavedPlan(islands)}) {
    const IslandLayout layout = IslandsOf(plan);

    ASSERT_EQ(layout.islands.size(), 2u);
    EXPECT_EQ(layout.islands[0].outer, 0);
    EXPECT_THAT(layout.islands[0].contours, ElementsAre(0, 1));
    EXPECT_THAT(layout.islands[0].rasters, ElementsAre(2));
    EXPECT_EQ(layout.islands[1].outer, 3);
    EXPECT_THAT(layout.island_of, ElementsAre(0, 0, 0, 1));
  }
}

TEST(IslandsOf, APathWithoutIslandIsItsOwn) {
  const Plan plan = testing::AnyOrderPlan({MakeContour({{0, 0}}), MakeOpenPath({1, 1}, {2, 2})});

  const IslandLayout layout = IslandsOf(plan);

  ASSERT_EQ(layout.islands.size(), 2u);
  EXPECT_EQ(layout.islands[0].outer, -1);
  EXPECT_THAT(layout.islands[0].contours, ElementsAre(0));
  EXPECT_THAT(layout.islands[1].rasters, ElementsAre(1));
}

TEST(AsClassicalLayer, IsContoursThenRasters) {
  const auto layer = AsClassicalLayer(SequentialPlan(testing::SquareGrid(2, 1)));

  ASSERT_TRUE(layer.has_value());
  EXPECT_THAT(layer->contours, ElementsAre(0, 2));
  EXPECT_THAT(layer->rasters, ElementsAre(1, 3));
}

TEST(AsClassicalLayer, MayLackAStage) {
  const auto contours = AsClassicalLayer(testing::FlatPlan(3));
  ASSERT_TRUE(contours.has_value());
  EXPECT_THAT(contours->contours, ElementsAre(0, 1, 2));
  EXPECT_THAT(contours->rasters, IsEmpty());

  const auto rasters = AsClassicalLayer(SequentialPlan({{{}, {MakeOpenPath({0, 0}, {1, 0})}}}));
  ASSERT_TRUE(rasters.has_value());
  EXPECT_THAT(rasters->rasters, ElementsAre(0));

  EXPECT_TRUE(AsClassicalLayer(Plan{}).has_value());
}

TEST(AsClassicalLayer, IsNothingElse) {
  EXPECT_FALSE(AsClassicalLayer(InterleavedPlan(testing::SquareGrid(2, 1))).has_value());
  EXPECT_FALSE(
      AsClassicalLayer(testing::AnyOrderPlan({MakeContour({{0, 0}}), MakeOpenPath({1, 1}, {2, 2})}))
          .has_value());

  Plan constrained = SequentialPlan(testing::SquareGrid(2, 1));
  constrained.nodes[1].before = {{0, 1}};
  EXPECT_FALSE(AsClassicalLayer(constrained).has_value());

  Plan swapped = SequentialPlan(testing::SquareGrid(2, 1));
  std::swap(swapped.nodes[0].children[0], swapped.nodes[0].children[1]);
  EXPECT_FALSE(AsClassicalLayer(swapped).has_value());
}

}  // namespace
}  // namespace traverse
