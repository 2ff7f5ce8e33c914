// What keeps its order within a layer: client/gcode/verify/rules/order.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/verify/small_prints.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

TEST(VerifyOrder, InfillStaysBehindTheWallBesideIt) {
  const std::string near = Line("Internal infill", "X12 Y10.4", "X18 Y10.4");
  const std::string far = Line("Internal infill", "X12 Y15", "X18 Y15");

  EXPECT_EQ(Broken(kHead + kSquare + near, kHead + near + kSquare), "order");
  EXPECT_EQ(Broken(kHead + kSquare + near, kHead + near + kSquare, Policy::kFree), "order");
  EXPECT_EQ(Broken(kHead + kSquare + far, kHead + far + kSquare), "");
  VerifyPermissions allowed;
  allowed.infill_order = true;
  EXPECT_EQ(Broken(kHead + kSquare + near, kHead + near + kSquare, allowed), "");
}

// A break says what has to come first, too.
TEST(VerifyOrder, NamesBothPathsOfTheOtherFile) {
  const std::string near = Line("Internal infill", "X12 Y10.4", "X18 Y10.4");
  VerifyOptions options;
  options.rules = RuleBit(VerifyRule::kOrder);
  const std::string other = kHead + near + kSquare;
  const VerifyReport report = CheckGcode(kHead + kSquare + near, "a", other, "b", options);
  ASSERT_EQ(report.breaks.size(), 1u);
  const auto line_of = [&other](const std::string& text) {
    const auto end = other.begin() + static_cast<std::ptrdiff_t>(other.find(text));
    return static_cast<size_t>(std::count(other.begin(), end, '\n') + 1);
  };
  EXPECT_EQ(report.breaks[0].optimised_line, line_of("G1 X18 Y10.4 E"));
  EXPECT_EQ(report.breaks[0].before_line, line_of("G1 X20 Y10 E"));
}

// All lines cross all others: pairs that need no order, or keep it, take no time.
TEST(VerifyOrder, ThousandsOfLinesThatCrossTakeAsLongEach) {
  const auto check = [](int count) {
    std::vector<std::string> lines;
    for (int i = 0; i < count; ++i) {
      const double x = i * 200.0 / count;
      lines.push_back(Line("Internal infill", absl::StrFormat("X%.3f Y0", x),
                           absl::StrFormat("X%.3f Y200", 200 - x)));
    }
    std::string was = kHead, is = kHead;
    for (int i = 0; i < count; ++i) {
      was += lines[static_cast<size_t>(i)];
      is += lines[static_cast<size_t>(i) * 7919 % static_cast<size_t>(count)];
    }
    Broken(was, is, Policy::kFree);
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(1500, check), traverse::testing::kSlowGrowth);
}

// Cells for all of them, no more than there are pieces, would be hundreds of metres wide.
TEST(VerifyOrder, NoneAreNearOnlyBecauseOneLiesFarAway) {
  std::string was = kHead + Line("External perimeter", "X900000 Y900000", "X900001 Y900000");
  std::string is = was;
  for (int i = 0; i < 3000; ++i) {
    const auto line = [](int number) {
      return Line("External perimeter", absl::StrFormat("X%d Y0", number),
                  absl::StrFormat("X%d Y1", number));
    };
    was += line(i);
    is += line(2999 - i);
  }

  EXPECT_EQ(Broken(was, is, Policy::kFree), "");
}

TEST(VerifyOrder, HoldsInLayersAboveTheFirstToo) {
  const std::string near = Line("Internal infill", "X12 Y10.4", "X18 Y10.4");
  const std::string far = Line("Internal infill", "X12 Y15", "X18 Y15");
  const std::string below = kHead + near + far + kNextLayer;

  EXPECT_EQ(Broken(below + kSquare + near, below + near + kSquare), "order");
  EXPECT_EQ(Broken(below + kSquare + far, below + far + kSquare), "");
}

TEST(VerifyOrder, WallsKeepTheirsUnderSafeAndBalanced) {
  const std::string inner = Line("Perimeter", "X12 Y10.4", "X18 Y10.4");

  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare), "order");
  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare, Policy::kBalanced), "order");
  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare, Policy::kFree), "");
  VerifyPermissions allowed;
  allowed.wall_order = true;
  EXPECT_EQ(Broken(kHead + kSquare + inner, kHead + inner + kSquare, allowed), "");
}

TEST(VerifyOrder, BridgesSupportAndSkirtsKeepTheirs) {
  for (const char* type : {"Bridge infill", "Support material", "Support material interface"}) {
    const std::string one = Line(type, "X0 Y0", "X9 Y0");
    const std::string other = Line("Internal infill", "X0 Y.4", "X9 Y.4");
    EXPECT_EQ(Broken(kHead + one + other, kHead + other + one, Policy::kFree), "order") << type;
    const std::string like = Line(type, "X0 Y.4", "X9 Y.4");
    EXPECT_EQ(Broken(kHead + one + like, kHead + like + one), "") << type;
  }
  const std::string skirt = Line("Skirt/Brim", "X0 Y0", "X9 Y0");
  EXPECT_EQ(Broken(kHead + skirt + kSquare, kHead + kSquare + skirt, Policy::kFree), "order");
  EXPECT_EQ(Broken(kHead + kTwo + skirt, kHead + kOneTurned + skirt), "") << "last, as it was";
  const std::string away = Line("Skirt/Brim", "X30 Y0", "X39 Y0");
  EXPECT_EQ(Broken(kHead + kTwo + away, kHead + kOther + kOne + away, Policy::kFree), "");
}

TEST(VerifyOrder, MonotonicSurfacesKeepTheirs) {
  const std::string one = Line("Top solid infill", "X0 Y0", "X9 Y0");
  const std::string two = Line("Top solid infill", "X0 Y.4", "X9 Y.4");
  EXPECT_EQ(Broken(kHead + one + two, kHead + two + one), "order");
  EXPECT_EQ(Broken(kHead + one + two, kHead + two + one, Policy::kFree), "");

  const std::string settings = "; top_fill_pattern = rectilinear\n";
  EXPECT_EQ(Broken(kHead + one + two + settings, kHead + two + one + settings), "");
}

TEST(VerifyOrder, ThinSkinOverSkinIsIroning) {
  const std::string head = "M83\n;LAYER:1\nG1 Z.2 F9000\n";
  const std::string skin = Line("SKIN", "X0 Y0", "X9 Y0") + Line("SKIN", "X0 Y.4", "X9 Y.4");
  const std::string iron = With(Line("SKIN", "X0 Y.2", "X9 Y.2"), "E.3", "E.02");
  const std::string beside = With(Line("SKIN", "X0 Y2", "X9 Y2"), "E.3", "E.02");

  EXPECT_EQ(Broken(head + skin + iron, head + iron + skin, Policy::kFree), "order");
  EXPECT_EQ(Broken(head + skin + beside, head + beside + skin, Policy::kFree), "");
}

// The narrow top of a letter: a wall around a ring of skin, and ironing over both.
TEST(VerifyOrder, IroningOfSmallTopsIsKnownByWhatLiesUnderIt) {
  const std::string head = "M83\n;LAYER:1\nG1 Z.2 F9000\n";
  const std::string wall = Travel("X0 Y0") +
                           ";TYPE:WALL-OUTER\nG1 F1800\nG1 X6 Y0 E.2\nG1 X6 Y1.6 E.05\n"
                           "G1 X0 Y1.6 E.2\nG1 X0 Y0 E.05\n";
  const std::string skin = Travel("X.4 Y.4") +
                           ";TYPE:SKIN\nG1 F1800\nG1 X5.6 Y.4 E.17\nG1 X5.6 Y.8 E.02\n"
                           "G1 X.4 Y.8 E.17\nG1 X.4 Y1.2 E.02\nG1 X5.6 Y1.2 E.17\n";
  const auto iron = [](bool turned) {
    const std::string points[] = {"X.5 Y.3", "X1.3 Y1.3", "X1.4 Y1.3", "X.6 Y.3",
                                  "X.7 Y.3", "X1.5 Y1.3", "X1.6 Y1.3"};
    std::string text = Travel(turned ? points[6] : points[0]) + ";TYPE:SKIN\nG1 F1800\n";
    for (int k = 1; k < 7; ++k) text += "G1 " + points[turned ? 6 - k : k] + " E.001\n";
    return text;
  };
  const std::string was = head + wall + skin + iron(false);

  for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
    EXPECT_EQ(Broken(was, head + wall + iron(false) + skin, policy), "order");
    EXPECT_EQ(Broken(was, head + wall + skin + iron(true), policy), "direction");
    EXPECT_EQ(Broken(was, was, policy), "");
  }
}

// A line that fills a gap, one that goes on to a wall where another ended, and one at the edge.
TEST(VerifyOrder, SkinBesideSkinIsNoIroning) {
  const std::string head = "M83\n;LAYER:1\nG1 Z.2 F9000\n";
  const std::string skin = Line("SKIN", "X0 Y0", "X9 Y0") + Line("SKIN", "X0 Y.8", "X9 Y.8") +
                           Line("SKIN", "X0 Y1.2", "X9 Y1.2") +
                           Line("SKIN", "X9.45 Y0", "X9.45 Y1.2");
  const std::string lines[] = {Line("SKIN", "X0 Y.4", "X9 Y.4"), Line("SKIN", "X9 Y.8", "X9.3 Y.8"),
                               Line("SKIN", "X3 Y1.6", "X6 Y1.6")};
  for (const std::string& line : lines) {
    EXPECT_EQ(Broken(head + skin + line, head + line + skin, Policy::kFree), "") << line;
  }
}

TEST(VerifyOrder, LinesOfIroningKeepTheirsUnderFreeToo) {
  const std::string one = Line("Ironing", "X0 Y0", "X9 Y0");
  const std::string two = Line("Ironing", "X0 Y.1", "X9 Y.1");
  EXPECT_EQ(Broken(kHead + one + two, kHead + two + one, Policy::kFree), "order");
  const std::string far = Line("Ironing", "X0 Y9", "X9 Y9");
  EXPECT_EQ(Broken(kHead + one + far, kHead + far + one, Policy::kFree), "");
}

TEST(VerifyOrder, NothingPassesATower) {
  const std::string tower = Line("Wipe tower", "X50 Y50", "X59 Y50");
  const std::string more = Line("Wipe tower", "X50 Y60", "X59 Y60");
  EXPECT_EQ(Broken(kHead + kTwo + tower, kHead + tower + kTwo, Policy::kFree), "order");
  EXPECT_EQ(Broken(kHead + tower + more, kHead + more + tower, Policy::kFree), "order");
  EXPECT_EQ(Broken(kHead + kTwo + tower + more, kHead + kOneTurned + tower + more), "");
}

TEST(VerifyOrder, NothingPassesAChangeOfTheFanUnderSafeAndBalanced) {
  const auto under = [](const char* fan, const std::string& path) {
    return absl::StrCat(fan, path);
  };
  const std::string last = Line("Internal infill", "X0 Y9", "X9 Y9") + "M106 S99\n";
  const std::string a = under("M106 S9\n", kOne) + under("M106 S99\n", kOther) + last;
  const std::string b =
      under("M106 S99\n", kOther) + under("M106 S9\n", kOne) + under("M106 S99\n", last);
  EXPECT_EQ(Broken(kHead + a, kHead + b), "order");
  EXPECT_EQ(Broken(kHead + a, kHead + b, Policy::kBalanced), "order");
  EXPECT_EQ(Broken(kHead + a, kHead + b, Policy::kFree), "");
  VerifyPermissions allowed;
  allowed.fan_order = true;
  EXPECT_EQ(Broken(kHead + a, kHead + b, allowed), "");
  // Where each path of the layer has its own, it goes with the path.
  EXPECT_EQ(Broken(kHead + under("M106 S9\n", kOne) + under("M106 S99\n", kOther) + "M106 S99\n",
                   kHead + under("M106 S99\n", kOther) + under("M106 S9\n", kOne) + "M106 S99\n"),
            "");
  const std::string same = "M106 S9\n" + kTwo;
  EXPECT_EQ(Broken(kHead + same, kHead + "M106 S9\n" + kOther + kOne), "");
}

}  // namespace
}  // namespace traverse::gcode
