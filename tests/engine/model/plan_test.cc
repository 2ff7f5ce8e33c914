#include "engine/model/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "engine/model/route.h"

namespace traverse {
namespace {

using ::testing::HasSubstr;

PlanNode Leaf(int path) { return PlanNode{PlanNode::Kind::kPath, path, {}, {}}; }
PlanNode AnyOrder(std::vector<int> children, std::vector<std::pair<int, int>> before = {}) {
  return PlanNode{PlanNode::Kind::kAnyOrder, 0, std::move(children), std::move(before)};
}

Plan TwoLeaves() {
  return Plan{{MakeContour({{0, 0}}), MakeOpenPath({1, 1}, {2, 2})},
              {AnyOrder({1, 2}), Leaf(0), Leaf(1)}};
}

std::string Fault(const Plan& plan) { return std::string(CheckPlan(plan).message()); }

TEST(CheckPlan, AcceptsDegenerateGeometry) {
  EXPECT_TRUE(CheckPlan(Plan{}).ok());
  EXPECT_TRUE(CheckPlan(TwoLeaves()).ok());
  EXPECT_TRUE(CheckPlan(SequentialPlan({{{}, {MakeOpenPath({1, 1}, {1, 1})}}, {}})).ok());
  EXPECT_TRUE(CheckPlan(InterleavedPlan({{{MakeContour({{1, 1}, {1, 1}})}, {}}})).ok());
}

TEST(CheckPlan, NamesTheCoordinateThatIsNotFinite) {
  Plan plan = TwoLeaves();
  plan.paths[1].points[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Fault(plan), "paths[1].points[1].y: not finite");

  plan.paths[1].points[1].y = 1e300;
  EXPECT_EQ(Fault(plan), "paths[1].points[1].y: beyond +-1e6 mm");
}

TEST(CheckPlan, NamesBadEntries) {
  Plan plan = TwoLeaves();
  plan.paths[0].allowed = {1};
  EXPECT_EQ(Fault(plan), "paths[0].entries[0]: 1 is not a vertex of a contour of 1");

  plan.paths[0].allowed = {0, 0};
  EXPECT_EQ(Fault(plan), "paths[0].entries[1]: 0 is repeated");
}

TEST(CheckPlan, NamesTheNodeOutsideTheTree) {
  Plan plan = TwoLeaves();
  plan.nodes[0].children = {1};
  EXPECT_EQ(Fault(plan), "nodes[2]: is not the child of any node");

  plan.nodes[0].children = {1, 1};
  EXPECT_EQ(Fault(plan), "nodes[0].any_order.children[1]: nodes[1] already has a parent");

  plan.nodes[0].children = {1, 0};
  EXPECT_EQ(Fault(plan), "nodes[0].any_order.children[1]: 0 is not the index of a later node");
}

TEST(CheckPlan, NamesThePathUsedTwiceOrNever) {
  Plan plan = TwoLeaves();
  plan.nodes[2].path = 0;
  EXPECT_EQ(Fault(plan), "nodes[2].path: path 0 is already that of nodes[1]");

  plan = TwoLeaves();
  plan.paths.push_back(MakeContour({{0, 0}}));
  EXPECT_EQ(Fault(plan), "paths[2]: is not the path of any node");

  plan.nodes.clear();
  EXPECT_EQ(Fault(plan), "nodes: empty, but there are paths");
}

TEST(CheckPlan, NamesTheCycle) {
  Plan plan = TwoLeaves();
  plan.nodes[0].before = {{0, 1}, {1, 0}};
  EXPECT_EQ(Fault(plan), "nodes[0].any_order.before: the pairs form a cycle");

  plan.nodes[0].before = {{0, 1}, {1, 1}};
  EXPECT_EQ(Fault(plan), "nodes[0].any_order.before[1]: child 1 cannot come before itself");

  plan.nodes[0].before = {{0, 2}};
  EXPECT_EQ(Fault(plan), "nodes[0].any_order.before[0].second: 2 is not the position of a child");
}

TEST(CheckPlan, RefusesATreeThatIsTooDeep) {
  Plan plan{{MakeContour({{0, 0}})}, {}};
  for (int i = 0; i < 10000; ++i) plan.nodes.push_back(AnyOrder({i + 1}));
  plan.nodes.push_back(Leaf(0));

  EXPECT_THAT(Fault(plan),
              HasSubstr("nodes[99].any_order.children[0]: nested deeper than 100 levels"));
}

TEST(GivenRoute, KeepsPairsThatContradictTheOrderOfChildren) {
  Plan plan = TwoLeaves();
  plan.nodes[0].before = {{1, 0}};

  EXPECT_EQ(GivenRoute(plan), (Route{{1, 0}, {0, 0}}));
}

TEST(GivenRoute, EntersAContourAtItsFirstAllowedVertex) {
  const Plan plan = SequentialPlan({{{MakeContour({{0, 0}, {1, 0}, {1, 1}}, {2, 1})}, {}}});

  EXPECT_EQ(GivenRoute(plan), (Route{{0, 2}}));
}

TEST(Plans, SequentialAndInterleavedHoldAllPathsIslandByIsland) {
  const std::vector<IslandPaths> islands = {
      {{MakeContour({{0, 0}}), MakeContour({{1, 1}})}, {MakeOpenPath({2, 2}, {3, 3})}},
      {{MakeContour({{4, 4}})}, {}}};

  const Plan sequential = SequentialPlan(islands);
  const Plan interleaved = InterleavedPlan(islands);

  ASSERT_TRUE(CheckPlan(sequential).ok());
  ASSERT_TRUE(CheckPlan(interleaved).ok());
  EXPECT_EQ(GivenRoute(sequential), (Route{{0, 0}, {1, 0}, {3, 0}, {2, 0}}));
  EXPECT_EQ(GivenRoute(interleaved), (Route{{0, 0}, {1, 0}, {2, 0}, {3, 0}}));
}

TEST(Plans, BuildersSayWhichIslandAPathBelongsTo) {
  const std::vector<IslandPaths> islands = {
      {{}, {MakeOpenPath({2, 2}, {3, 3})}},
      {{MakeContour({{0, 0}}), MakeContour({{1, 1}})}, {MakeOpenPath({2, 2}, {3, 3})}}};

  for (const Plan& plan : {SequentialPlan(islands), InterleavedPlan(islands)}) {
    ASSERT_EQ(plan.paths.size(), 4u);
    EXPECT_EQ(plan.paths[0].island, 0);
    EXPECT_FALSE(plan.paths[0].outer);
    for (size_t p = 1; p < 4; ++p) {
      EXPECT_EQ(plan.paths[p].island, 1);
      EXPECT_EQ(plan.paths[p].outer, p == 1);
    }
  }
  EXPECT_EQ(MakeContour({{0, 0}}).island, -1);
}

}  // namespace
}  // namespace traverse
