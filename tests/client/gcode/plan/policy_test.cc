#include "client/gcode/plan/policy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "client/gcode/read/reader.h"
#include "tests/client/gcode/plan/sheet.h"
#include "tests/client/gcode/support/samples.h"

namespace traverse::gcode {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

TEST(Policy, PathsOfAGroupMayChangePlacesAndTheEndsMayNot) {
  const LayerPlan plan = Sheet().Line(kInfill, 0, 0, 9, 0).Line(kInfill, 0, 5, 9, 5).Plan();

  EXPECT_THAT(Groups(plan.plan), ElementsAre(ElementsAre(0), ElementsAre(1, 2), ElementsAre(3)));
  EXPECT_THAT(Pairs(plan.plan), IsEmpty());
  EXPECT_EQ(plan.movable, 2);
}

// What the plan says as a tree, for whoever changes an order bit by bit.
TEST(Policy, TheFreedomOfALayerIsThatOfItsPlan) {
  Sheet sheet;
  sheet.Square(kOuter, 0, 0, 10).Line(kInfill, 0.4, 5, 9.6, 5).Line(kInfill, 30, 0, 39, 0);
  const LayerFreedom freedom = sheet.Plan(Policy::kBalanced).freedom;

  ASSERT_EQ(freedom.rules.size(), 5u);
  EXPECT_TRUE(freedom.rules[0].pinned);
  EXPECT_TRUE(freedom.rules[1].contour);
  EXPECT_FALSE(freedom.rules[2].one_way);
  EXPECT_THAT(freedom.group, ElementsAre(0, 1, 1, 1, 4));
  EXPECT_THAT(freedom.ordered, ElementsAre(Pair(1, 2)));
  EXPECT_THAT(freedom.goes_on, ElementsAre(false, false, false, false, false));

  Sheet ironing;
  ironing.Line(";TYPE:Ironing", 0, 0, 9, 0).Line(";TYPE:Ironing", 0, 5, 9, 5);
  EXPECT_THAT(ironing.Plan().freedom.goes_on, ElementsAre(false, false, true, false));
}

TEST(Policy, SafeKeepsTheStartOfVisibleWallsAlone) {
  Sheet sheet;
  sheet.Square(kInner, 0, 0, 10).Square(kOuter, 30, 0, 10);
  Sheet same = sheet;

  const LayerPlan safe = sheet.Plan();
  const LayerPlan free = same.Plan(Policy::kFree);

  EXPECT_THAT(safe.plan.paths(1).contour().entries(), IsEmpty());
  EXPECT_THAT(safe.plan.paths(2).contour().entries(), ElementsAre(0));
  EXPECT_THAT(free.plan.paths(2).contour().entries(), IsEmpty());
}

TEST(Policy, SafeKeepsTheStartOfOverhangsToo) {
  Sheet sheet;
  sheet.Square(";TYPE:Overhang perimeter", 0, 0, 10);
  Sheet same = sheet;

  EXPECT_THAT(sheet.Plan().plan.paths(1).contour().entries(), ElementsAre(0));
  EXPECT_THAT(same.Plan(Policy::kFree).plan.paths(1).contour().entries(), IsEmpty());
}

// Turned round it would end where it did: nothing is gained.
TEST(Policy, ACircleOfOneOrTwoArcsIsAContourWithOneEntryUnderAnyPolicy) {
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    Sheet sheet;
    sheet.Add("G0 X20 Y10").Add(kInner).Add("G2 X20 Y10 I-5 E1");
    sheet.Add("G0 X60 Y10").Add("G3 X40 Y10 R10 E1").Add("G3 X60 Y10 R10 E1");

    const LayerPlan plan = sheet.Plan(policy);

    EXPECT_THAT(plan.plan.paths(1).contour().entries(), ElementsAre(0));
    EXPECT_THAT(plan.plan.paths(2).contour().entries(), ElementsAre(0));
  }
}

TEST(Policy, AFullCircleWithinAPathKeepsItsDirection) {
  Sheet sheet;
  sheet.Add("G0 X20 Y10").Add(kInfill).Add("G1 X30 Y10 E1").Add("G2 X30 Y10 I5 E1");
  sheet.Add("G1 X40 Y12 E1").Line(kInfill, 60, 0, 69, 0);

  const LayerPlan plan = sheet.Plan(Policy::kFree);

  EXPECT_TRUE(plan.plan.paths(1).open_path().one_way());
  EXPECT_FALSE(plan.plan.paths(2).open_path().one_way());
}

TEST(Policy, BalancedStartsVisibleWallsAtTheirCorners) {
  Sheet sheet;
  sheet.Path(kOuter, {{5, 0}, {10, 0}, {10, 10}, {5, 10.3}, {0, 10}, {0, 0}, {5, 0}});

  const LayerPlan plan = sheet.Plan(Policy::kBalanced);

  EXPECT_THAT(plan.plan.paths(1).contour().entries(), ElementsAre(0, 1, 2, 4, 5));
}

// So that a search does not take minutes for loops of thousands of vertices.
TEST(Policy, LoopsOfVeryManyVerticesMayBeginAtAFewHundred) {
  std::vector<Point> circle;
  for (int k = 0; k <= 5000; ++k) {
    const double turn = 2 * std::numbers::pi * (k % 5000) / 5000;
    circle.push_back({50 + 20 * std::cos(turn), 50 + 20 * std::sin(turn)});
  }
  Sheet sheet;
  sheet.Path(kOuter, circle);

  const auto entries = sheet.Plan(Policy::kFree).plan.paths(1).contour().entries();

  EXPECT_EQ(entries.Get(0), 0);
  EXPECT_GT(entries.size(), 200);
  EXPECT_LT(entries.size(), 300);
}

// What any policy allows, the next one allows too.
TEST(Policy, IslandsMayBeMixedUnderAnyPolicy) {
  Sheet sheet;
  sheet.Line(kInfill, 0, 0, 9, 0).Line(kInfill, 30, 0, 39, 0).Line(kInfill, 0, .4, 9, .4);

  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    const v1::Plan plan = sheet.Plan(policy).plan;
    const v1::PlanNode& group = plan.nodes(static_cast<int>(plan.nodes(0).in_order().children(1)));
    EXPECT_EQ(group.any_order().children_size(), 3) << PolicyName(policy);
  }
}

TEST(Policy, DirectionIsFreeForInfillAndUnderFreeForOpenWalls) {
  Sheet sheet;
  sheet.Line(kInfill, 0, 0, 9, 0).Line(kInner, 0, 5, 9, 5);
  Sheet same = sheet;

  const LayerPlan safe = sheet.Plan();
  const LayerPlan free = same.Plan(Policy::kFree);

  EXPECT_FALSE(safe.plan.paths(1).open_path().one_way());
  EXPECT_TRUE(safe.plan.paths(2).open_path().one_way());
  EXPECT_FALSE(free.plan.paths(2).open_path().one_way());
}

TEST(Policy, BridgesAndInterfacesKeepTheirPlacesUnderAnyPolicy) {
  Sheet sheet;
  sheet.Line(";TYPE:Solid infill", 0, 0, 9, 0).Line(";TYPE:Bridge infill", 9.2, -5, 9.2, 5);
  sheet.Line(";TYPE:Support material", 30, 0, 39, 0);
  sheet.Line(";TYPE:Support material interface", 30, .4, 39, .4);

  EXPECT_THAT(Pairs(sheet.Plan(Policy::kFree).plan), UnorderedElementsAre(Pair(1, 2), Pair(3, 4)));
}

TEST(Policy, SkirtsAndObjectsAndFansDivideALayer) {
  Sheet sheet;
  sheet.Line(";TYPE:Skirt/Brim", 0, 0, 9, 0);
  sheet.Line(kInfill, 0, 5, 9, 5);
  sheet.Add("; printing object a id:0 copy 0").Line(kInfill, 0, 9, 9, 9);
  sheet.Add("M106 S255").Line(kInfill, 0, 15, 9, 15);
  Sheet same = sheet;

  EXPECT_THAT(Groups(sheet.Plan().plan),
              ElementsAre(ElementsAre(0), ElementsAre(1), ElementsAre(2), ElementsAre(3),
                          ElementsAre(4), ElementsAre(5)));
  EXPECT_THAT(Groups(same.Plan(Policy::kFree).plan), Contains(ElementsAre(3, 4)));
}

TEST(Policy, WhatIsAllowedByNameMayChangePlacesAndNothingElse) {
  Sheet sheet;
  sheet.Square(kInner, 0.4, 0.4, 9.2).Square(kOuter, 0, 0, 10).Line(kInfill, 0.8, 5, 9, 5);
  sheet.Line(";TYPE:Bridge infill", 0.8, 5.2, 9, 5.2);
  const auto pairs = [&sheet](const Allowance& allow) {
    Sheet same = sheet;
    return Pairs(same.PlanAllowing(allow).plan);
  };

  EXPECT_THAT(pairs({}), UnorderedElementsAre(Pair(1, 2), Pair(1, 3), Pair(1, 4), Pair(3, 4)));
  EXPECT_THAT(pairs({.infill_order = true}),
              UnorderedElementsAre(Pair(1, 2), Pair(1, 4), Pair(3, 4)));
  EXPECT_THAT(pairs({.wall_order = true}),
              UnorderedElementsAre(Pair(1, 3), Pair(1, 4), Pair(3, 4)));
  EXPECT_THAT(pairs({.infill_order = true, .wall_order = true}),
              UnorderedElementsAre(Pair(1, 4), Pair(3, 4)));
}

TEST(Policy, AChangeOfTheFanDividesALayerUnlessThatIsAllowed) {
  Sheet sheet;
  sheet.Line(kInfill, 0, 5, 9, 5).Add("M106 S255").Line(kInfill, 0, 15, 9, 15);
  Sheet same = sheet;

  EXPECT_THAT(Groups(sheet.Plan().plan), Contains(ElementsAre(2)));
  EXPECT_THAT(Groups(same.PlanAllowing({.fan_order = true}).plan), Contains(ElementsAre(1, 2)));
}

TEST(Policy, NamesOfWhatIsAllowedAreReadAndWritten) {
  const Allowance both = {.infill_order = true, .fan_order = true};

  EXPECT_EQ(AllowanceOfNames("fan_order,infill_order"), both);
  EXPECT_EQ(AllowanceNames(both), "infill_order+fan_order");
  EXPECT_EQ(AllowanceOfNames("wipes"), Allowance{.wipes = true});
  EXPECT_EQ(AllowanceOfNames(""), Allowance{});
  EXPECT_EQ(AllowanceNames({}), "");
  for (const char* wrong : {"infill", "infill_order,", ",infill_order", "wall_order fan_order"}) {
    EXPECT_EQ(AllowanceOfNames(wrong), std::nullopt) << wrong;
  }
}

TEST(Policy, TowersArePinned) {
  Sheet sheet;
  sheet.Line(kInfill, 0, 0, 9, 0).Line(";TYPE:Wipe tower", 0, 5, 9, 5);
  sheet.Line(";TYPE:Wipe tower", 0, 9, 9, 9).Line(kInfill, 0, 15, 9, 15);

  EXPECT_EQ(sheet.Plan(Policy::kFree).movable, 0);
}

TEST(Policy, NamesAndNumbersAgree) {
  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    EXPECT_EQ(PolicyOfName(PolicyName(policy)), policy);
  }
  EXPECT_EQ(PolicyOfName("reckless"), std::nullopt);
}

TEST(Policy, SupportIsFreeButForItsInterfaces) {
  const auto pairs = [](const std::string& type, Policy policy) {
    Sheet sheet;
    sheet.Line(type, 30, 0, 39, 0).Line(type, 30, .4, 39, .4);
    return Pairs(sheet.Plan(policy).plan);
  };
  for (const Policy policy : {Policy::kSafe, Policy::kFree}) {
    EXPECT_THAT(pairs(";TYPE:Support material", policy), IsEmpty());
    EXPECT_THAT(pairs(";TYPE:Support material interface", policy), ElementsAre(Pair(1, 2)));
  }
}

}  // namespace
}  // namespace traverse::gcode
