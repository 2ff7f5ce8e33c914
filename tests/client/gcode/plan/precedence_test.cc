#include "client/gcode/plan/precedence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "client/gcode/read/reader.h"
#include "tests/client/gcode/plan/sheet.h"

namespace traverse::gcode {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

TEST(Precedence, PathsOfDifferentFeaturesThatTouchKeepTheirOrder) {
  Sheet sheet;
  sheet.Square(kInner, 0, 0, 10).Square(kOuter, -0.4, -0.4, 10.8).Line(kInfill, 0.3, 5, 9.7, 5);
  sheet.Square(kInner, 30, 0, 10).Line(kInfill, 30.3, 5, 39.7, 5);

  const LayerPlan plan = sheet.Plan();

  EXPECT_THAT(Pairs(plan.plan), UnorderedElementsAre(Pair(1, 2), Pair(1, 3), Pair(4, 5)));
  EXPECT_EQ(plan.freedom.island[1], plan.freedom.island[3]);
  EXPECT_NE(plan.freedom.island[1], plan.freedom.island[4]);
}

TEST(Precedence, NestedWallsKeepTheirOrderUnlessFree) {
  Sheet sheet;
  sheet.Square(kInner, 0.4, 0.4, 9.2).Square(kInner, 0, 0, 10);
  Sheet same = sheet;

  EXPECT_THAT(Pairs(sheet.Plan().plan), ElementsAre(Pair(1, 2)));
  EXPECT_THAT(Pairs(same.Plan(Policy::kFree).plan), IsEmpty());
}

TEST(Precedence, WallsSideBySideKeepTheirOrder) {
  Sheet sheet;
  sheet.Square(kInner, 0, 0, 10).Square(kInner, 10.4, 0, 10);  // of two holes
  sheet.Square(kOuter, 30, 0, 10).Square(kInner, 40.4, 0, 10);
  sheet.Square(kInner, 60, 0, 10).Square(kInner, 60.4, 0.4, 9.2);
  sheet.Square(kOuter, 80.4, 0.4, 9.2).Square(kOuter, 80, 0, 10);
  sheet.Square(kOuter, 100, 0, 10).Line(kOuter, 100.4, 1, 100.4, 9);

  EXPECT_THAT(Pairs(sheet.Plan().plan),
              UnorderedElementsAre(Pair(1, 2), Pair(3, 4), Pair(5, 6), Pair(7, 8), Pair(9, 10)));
}

TEST(Precedence, WallsBeforeInfillStayUnderFreeWhereTheyTouch) {
  Sheet sheet;
  sheet.Square(kInner, 0, 0, 10).Line(kInfill, 0.3, 5, 9.7, 5).Line(kInfill, 30, 5, 40, 5);

  EXPECT_THAT(Pairs(sheet.Plan(Policy::kFree).plan), ElementsAre(Pair(1, 2)));
}

// Neighbors lie 0.9 widths apart; where there is air between two lines, they do not touch.
TEST(Precedence, LinesTouchUpToElevenTenthsOfTheirWidth) {
  Sheet sheet;
  sheet.Add(";WIDTH:0.8");
  sheet.Line(kInner, 0, 0, 9, 0).Line(kInfill, 0, .87, 9, .87);
  sheet.Line(kInner, 30, 0, 39, 0).Line(kInfill, 30, .89, 39, .89);

  EXPECT_THAT(Pairs(sheet.Plan().plan), ElementsAre(Pair(1, 2)));
}

// Thin lines are near each other at half a millimetre, however thin they are.
TEST(Precedence, NearIsHalfAMillimetreAtLeast) {
  Sheet sheet;
  sheet.Add(";WIDTH:0.25");
  sheet.Line(kInner, 0, 0, 9, 0).Line(kInfill, 0, .49, 9, .49);

  EXPECT_THAT(Pairs(sheet.Plan().plan), ElementsAre(Pair(1, 2)));
}

// CuraEngine calls its ironing SKIN: thin lines over skin that was printed before.
TEST(Precedence, IroningOfCuraStaysBehindWhatItIrons) {
  std::string text = ";Generated with Cura_SteamEngine 5.13.0\nM83\n;LAYER:0\n;TYPE:WALL-OUTER\n";
  const auto line = [&text](double y, const char* filament) {
    text += absl::StrCat("G0 X0 Y", y, "\nG1 X10 Y", y, " E", filament, "\n");
  };
  line(50, ".3");
  text += ";TYPE:SKIN\n";
  line(0, ".3");
  line(.4, ".3");
  line(.1, ".03");  // over these two
  line(.2, ".03");
  line(30, ".3");
  text += ";TYPE:WALL-OUTER\n";
  line(60, ".3");
  const auto file = *ReadGcode(text, "cura.gcode");

  const LayerPlan plan = MakeLayerPlan(*file, file->layers[0], Policy::kFree);

  EXPECT_EQ(plan.outlines[2].feature, Feature::kSolidInfill);
  EXPECT_EQ(plan.outlines[3].feature, Feature::kIroning);
  EXPECT_EQ(plan.outlines[4].feature, Feature::kIroning);
  EXPECT_EQ(plan.outlines[5].feature, Feature::kSolidInfill);
  const v1::PlanNode& group =
      plan.plan.nodes(1).has_any_order() ? plan.plan.nodes(1) : plan.plan.nodes(2);
  ASSERT_TRUE(group.has_any_order());
  EXPECT_GE(group.any_order().before_size(), 2);
}

TEST(Precedence, MonotonicLinesKeepOrderAndDirection) {
  Sheet sheet;
  sheet.Line(kTop, 0, 0, 9, 0).Line(kTop, 0, .4, 9, .4).Line(kTop, 30, 0, 39, 0);

  const LayerPlan plan = sheet.Plan();

  EXPECT_THAT(Pairs(plan.plan), ElementsAre(Pair(1, 2)));
  EXPECT_TRUE(plan.plan.paths(1).open_path().one_way());
}

TEST(Precedence, LinesThatAreKnownNotToBeMonotonicAreFree) {
  Sheet sheet;
  sheet.Line(kTop, 0, 0, 9, 0).Line(kTop, 0, .4, 9, .4).Add("; top_fill_pattern = rectilinear");

  EXPECT_THAT(Pairs(sheet.Plan().plan), IsEmpty());
}

// Every line touches every other: a square of their number, which nobody waits for.
TEST(Precedence, PathsInOnePlaceByTheThousandStayAsTheyAre) {
  Sheet sheet;
  for (int i = 0; i < 6000; ++i) sheet.Line(";TYPE:Internal infill", 0, 0, 9, 0);

  const LayerPlan plan = sheet.Plan(Policy::kFree);

  EXPECT_EQ(plan.movable, 0);
  EXPECT_EQ(plan.plan.nodes(0).in_order().children_size(), plan.plan.paths_size());
}

// Each line of infill crosses each wall, and would have to wait for it.
TEST(Precedence, PathsThatAllKeepTheirOrderWithOneAnotherStayAsTheyAre) {
  Sheet sheet;
  for (int i = 0; i < 100; ++i) sheet.Line(kInner, 0, 2 * i, 200, 2 * i);
  for (int i = 0; i < 100; ++i) sheet.Line(kInfill, 2 * i, 0, 2 * i, 200);

  const LayerPlan plan = sheet.Plan(Policy::kFree);

  EXPECT_EQ(plan.movable, 0);
  EXPECT_THAT(Pairs(plan.plan), IsEmpty());
}

// As close as paths of a part are to one another, but a whole layer of them.
TEST(Precedence, ManyPathsSideBySideMayMove) {
  Sheet sheet;
  for (int i = 0; i < 6000; ++i) {
    sheet.Line(";TYPE:Internal infill", 0.5 * (i % 80), 0.4 * (i / 80), 0.5 * (i % 80) + 0.4,
               0.4 * (i / 80));
  }

  EXPECT_GE(sheet.Plan(Policy::kFree).movable, 6000);
}

}  // namespace
}  // namespace traverse::gcode
