// Whole labelled objects change places within a layer: choose/object_orders.h,
// verify/match/moved_objects.h.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/gcode/model/loops.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/rewrite.h"
#include "tests/client/gcode/labels/pillars.h"
#include "tests/client/gcode/support/verified.h"
#include "tests/support/growth.h"

namespace traverse::gcode {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::Notation;
using testing::Notations;
using testing::PillarPrint;

// Without `polish` as for a strategy that is asked for by name.
GcodeRewrite Optimised(const std::string& text, Policy policy = Policy::kSafe,
                       std::optional<PolishLimit> polish = PolishLimit{}) {
  const auto file = ReadGcode(text, "part.gcode");
  EXPECT_TRUE(file.ok()) << file.status();
  FileOrder found;
  for (const Layer& layer : (*file)->layers) {
    LayerOrder& order = found.emplace_back();
    const std::vector<Outline> outlines = OutlinesOf(**file, layer);
    for (uint32_t i = 0; i < outlines.size(); ++i) {
      order.push_back({layer.first_block + i, 0, outlines[i].closed});
    }
  }
  RewriteOptions options;
  options.policy = policy;
  options.polish = std::move(polish);
  const auto rewrite = RewriteGcode(**file, found, options);
  EXPECT_TRUE(rewrite.ok()) << rewrite.status();
  return *rewrite;
}

double Share(const GcodeRewrite& rewrite) {
  return rewrite.after.travel_mm / rewrite.before.travel_mm;
}

std::string Broken(const std::string& was, const std::string& is) {
  return std::string(VerifyGcode(was, "a", is, "b", {}).message());
}

Notation Klipper() { return Notations()[1]; }

constexpr char kUnknownAndPicture[] =
    "ON_LAYER_CHANGE\nG1 E-.8 F2100\nTIMELAPSE_TAKE_FRAME\nG1 E.8 F2100\n";

// The pillar of a line that deposits: by its place.
int PillarAt(const std::string& line) {
  double x = 0;
  double y = 0;
  for (const auto word : absl::StrSplit(line, ' ')) {
    if (word.empty()) continue;
    double& axis = word[0] == 'X' ? x : y;
    if (word[0] == 'X' || word[0] == 'Y') {
      EXPECT_TRUE(absl::SimpleAtod(word.substr(1), &axis));
    }
  }
  return (x > 100 ? 1 : 0) + (y > 100 ? 2 : 0);
}

// Whether all deposits of `text` stand behind the label of their pillar, and no other.
bool LabelledRight(const std::string& text, const Notation& notation) {
  int label = -1;
  std::vector<std::string> begins;
  for (int n = 0; n < 4; ++n) {
    begins.push_back(std::vector<std::string>(absl::StrSplit(notation.begin(n), '\n'))[0]);
  }
  const std::vector<std::string> lines = absl::StrSplit(text, '\n');
  for (const std::string& line : lines) {
    for (int n = 0; n < 4; ++n) {
      if (line == begins[static_cast<size_t>(n)]) label = n;
    }
    const bool deposits = absl::StrContains(line, "X") && absl::StrContains(line, " E");
    if (deposits && PillarAt(line) != label) return false;
  }
  return true;
}

TEST(MovedObjects, ChangePlacesInEveryNotation) {
  for (const Notation& notation : Notations()) {
    for (const Policy policy : {Policy::kSafe, Policy::kBalanced, Policy::kFree}) {
      const std::string text = Text(PillarPrint{}, notation);
      const GcodeRewrite rewrite = Optimised(text, policy);
      EXPECT_LT(Share(rewrite), 0.9) << notation.name << " " << rewrite.unproven;
      EXPECT_TRUE(LabelledRight(rewrite.text, notation)) << notation.name;
      EXPECT_EQ(rewrite.layers_unproven, 0) << notation.name << " " << rewrite.unproven;
    }
  }
}

TEST(MovedObjects, ChangePlacesWithoutFurtherSearch) {
  const GcodeRewrite rewrite =
      Optimised(Text(PillarPrint(), Klipper()), Policy::kSafe, std::nullopt);
  EXPECT_LT(Share(rewrite), 0.9) << rewrite.unproven;
  EXPECT_EQ(rewrite.layers_unproven, 0) << rewrite.unproven;
}

// The first object of the first layer and the last one of the last layer cannot move; all others
// do, though every object rests as long as before.
TEST(MovedObjects, ChangePlacesBetweenTheFirstAndTheLastOne) {
  PillarPrint print;
  print.order = {0, 3, 1, 4, 2, 5};
  for (const int rest : {7, 13}) {
    const std::string text = absl::StrReplaceAll(
        Text(print, Klipper()), {{"layer_time = 0", absl::StrCat("layer_time = ", rest)}});
    const GcodeRewrite rewrite = Optimised(text);
    EXPECT_LT(Share(rewrite), 0.95) << rest << rewrite.unproven;
    EXPECT_EQ(rewrite.layers_changed, print.layers) << rest;
  }
}

TEST(MovedObjects, TakeWhatStandsAtTheirLabelsAlong) {
  PillarPrint print;
  print.before_object = "M117 object @\nSET_PRESSURE_ADVANCE ADVANCE=0.04\nM204 S900\n";
  print.before_layer = "G1 E-.8 F2100\nTIMELAPSE_TAKE_FRAME\nG1 E.8 F2100\n";
  const GcodeRewrite rewrite = Optimised(Text(print, Klipper()));
  EXPECT_LT(Share(rewrite), 0.9) << rewrite.unproven;
  EXPECT_TRUE(LabelledRight(rewrite.text, Klipper()));
}

// Of those of a layer, too, behind which another object begins.
TEST(MovedObjects, LeaveUnknownLinesWhereTheyAre) {
  for (const Notation& notation : Notations()) {
    for (const Policy policy : {Policy::kSafe, Policy::kFree, Policy::kFast}) {
      PillarPrint print;
      print.before_layer = kUnknownAndPicture;
      const GcodeRewrite rewrite = Optimised(Text(print, notation), policy);
      EXPECT_LT(Share(rewrite), 0.95) << notation.name << " " << rewrite.unproven;
      EXPECT_EQ(rewrite.layers_unproven, 0) << notation.name << " " << rewrite.unproven;
      EXPECT_TRUE(LabelledRight(rewrite.text, notation)) << notation.name;
    }
  }
}

// Whichever object stood there in the file.
TEST(MovedObjects, AreTravelledToAsFastAsTheyAre) {
  PillarPrint print;
  print.before_object = "M220 S9@\n";
  const GcodeRewrite rewrite = Optimised(Text(print, Klipper()));
  EXPECT_LT(Share(rewrite), 0.9) << rewrite.unproven;

  std::string object;
  std::string speed;
  const std::vector<std::string> lines = absl::StrSplit(rewrite.text, '\n');
  for (const std::string& line : lines) {
    if (absl::StartsWith(line, "EXCLUDE_OBJECT_START")) object = line.substr(line.size() - 1);
    if (absl::StartsWith(line, "M220 S9")) speed = line.substr(7);
    const bool travels = absl::StartsWith(line, "G1 X") && !absl::StrContains(line, " E");
    if (travels && !object.empty()) {
      EXPECT_EQ(speed, object) << line;
    }
    if (absl::StartsWith(line, "EXCLUDE_OBJECT_END")) object.clear();
  }
}

// The wipe of a path stands within the label of the next object; two objects still follow each
// other.
TEST(MovedObjects, KeepTheWipeBetweenNeighbors) {
  for (const Notation& notation : Notations()) {
    PillarPrint print;
    print.wipes = true;
    const GcodeRewrite rewrite = Optimised(Text(print, notation));
    EXPECT_LT(Share(rewrite), 0.9) << notation.name << " " << rewrite.unproven;
    EXPECT_EQ(rewrite.layers_unproven, 0) << notation.name << " " << rewrite.unproven;
  }
}

// A wipe goes with its path, and not with the labels behind it.
TEST(MovedObjects, LeaveNoWipeBehind) {
  for (const Notation& notation : Notations()) {
    PillarPrint print;
    print.wipes = true;
    print.unwiped = 2;
    const GcodeRewrite rewrite = Optimised(Text(print, notation));
    EXPECT_LT(Share(rewrite), 0.9) << notation.name << " " << rewrite.unproven;
    EXPECT_EQ(rewrite.layers_unproven, 0) << notation.name << " " << rewrite.unproven;
  }
}

// A picture taken amid an object stays with it, as what else is done there.
TEST(MovedObjects, StayWhereOneHasAPictureTakenWithinIt) {
  const std::string text = absl::StrReplaceAll(
      Text(PillarPrint(), Klipper()),
      {{"EXCLUDE_OBJECT_START NAME=p1\nG1 E-.8 F2100\n",
        "EXCLUDE_OBJECT_START NAME=p1\nG1 E-.8 F2100\nTIMELAPSE_TAKE_FRAME\n"}});
  ASSERT_THAT(text, HasSubstr("TIMELAPSE"));
  const GcodeRewrite rewrite = Optimised(text);
  EXPECT_EQ(rewrite.layers_unproven, 0) << rewrite.unproven;
}

TEST(MovedObjects, StayInPrintsObjectByObject) {
  PillarPrint print;
  print.one_by_one = true;
  const std::string text = Text(print, Klipper());
  const GcodeRewrite rewrite = Optimised(text);
  EXPECT_EQ(rewrite.layers_changed, 0);
  EXPECT_EQ(rewrite.text, text);
}

TEST(MovedObjects, StayWherePrintedTwice) {
  PillarPrint print;
  print.order = {0, 2, 0, 3, 1};
  EXPECT_EQ(Optimised(Text(print, Klipper())).layers_changed, 0);
}

TEST(MovedObjects, LeaveNoneOfTheirPathsUnderTheLabelOfAnother) {
  const Notation cura = Notations()[6];
  const PillarPrint print;
  const std::string head = "M83\n" + testing::LayerMark(.2) + "G1 Z.2 F9000\nG1 E-.8 F2100\n";
  const std::string rest = "G1 Z.1 F9000\nG1 X141 Y57\nG1 F2400\nG1 X141 Y63 E.2\n;MESH:NONMESH\n";
  const auto objects = [&](int first, int second) {
    return head + ObjectOf(print, cura, first, -1) + cura.end(first) +
           ObjectOf(print, cura, second, first) + rest;
  };

  EXPECT_EQ(Broken(objects(0, 1), objects(0, 1)), "");
  EXPECT_THAT(Broken(objects(0, 1), objects(1, 0)), HasSubstr("other labels"));
}

TEST(MovedObjects, DoNotPassATemperatureOrAnUnknownCommand) {
  for (const std::string between : {"M104 S210\nM104 S215\n", "WIPE_NOZZLE\n", "M400\n", "T1\n"}) {
    PillarPrint print;
    print.between = between;
    EXPECT_EQ(Optimised(Text(print, Klipper())).layers_changed, 0) << between;
  }
}

// Nothing could undo it for an object that came to stand behind it.
TEST(MovedObjects, DoNotPassWhatIsSetForTheFirstTime) {
  const std::string paths = ";TYPE:External perimeter\n";
  for (const std::string& where : {paths, std::string("EXCLUDE_OBJECT_START NAME=p1\n")}) {
    std::string text = Text(PillarPrint(), Klipper());
    size_t at = text.find(";Z:0.6\n");
    for (int i = 0; i < (where == paths ? 3 : 1); ++i) at = text.find(where, at + 1);
    text.insert(at + where.size(), "M220 S90\n");
    const GcodeRewrite rewrite = Optimised(text);
    EXPECT_EQ(rewrite.layers_unproven, 0) << rewrite.unproven;
    EXPECT_LT(Share(rewrite), 0.95) << "other layers";
  }
}

TEST(MovedObjects, StayInOrderWhereTheyTouch) {
  PillarPrint print;
  print.apart = 8.4;
  const GcodeRewrite rewrite = Optimised(Text(print, Klipper()));
  EXPECT_EQ(rewrite.layers_changed, 0);
}

TEST(MovedObjects, LabelsThatNeverEndAreKept) {
  const std::string text =
      absl::StrReplaceAll(Text(PillarPrint{}, Klipper()), {{"EXCLUDE_OBJECT_END NAME=p2\n", ""}});
  const GcodeRewrite rewrite = Optimised(text);
  EXPECT_EQ(Broken(text, rewrite.text), "");
}

// The blocks of the layer's objects, cut at their first lines, in another order by hand.
std::string WithLayer(const std::string& text, int layer, const std::vector<size_t>& order) {
  std::vector<std::string> layers = absl::StrSplit(text, ";LAYER_CHANGE\n");
  std::string& one = layers[static_cast<size_t>(layer)];
  std::vector<std::string> parts = absl::StrSplit(one, "; printing object");
  std::string last = parts.back();
  std::string moved = parts[0];
  for (const size_t object : order) absl::StrAppend(&moved, "; printing object", parts[object + 1]);
  one = moved;
  return absl::StrJoin(layers, ";LAYER_CHANGE\n");
}

TEST(VerifyMovedObjects, WholeObjectsMayMove) {
  const std::string text = Text(PillarPrint{}, Klipper());
  EXPECT_EQ(Broken(text, WithLayer(text, 3, {1, 0, 2, 3})), "");
  EXPECT_EQ(Broken(text, WithLayer(text, 3, {3, 2, 1, 0})), "");
}

TEST(VerifyMovedObjects, CatchesWhatIsPlanted) {
  const std::string text = Text(PillarPrint{}, Klipper());
  const std::string moved = WithLayer(text, 3, {1, 0, 2, 3});
  const size_t layer = moved.find(";Z:0.6");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string other = moved;
    const size_t at = other.find(from, layer);
    EXPECT_NE(at, std::string::npos) << from;
    return other.replace(at, from.size(), to);
  };
  EXPECT_EQ(Broken(text, moved), "");
  // An object under the label of another one.
  EXPECT_NE(Broken(text, with("EXCLUDE_OBJECT_START NAME=p0", "EXCLUDE_OBJECT_START NAME=p3")), "");
  EXPECT_NE(Broken(text, with("; printing object p0\n", "; printing object p1\n")), "");
  // A label that does not end, and one that ends what was not begun.
  EXPECT_NE(Broken(text, with("EXCLUDE_OBJECT_END NAME=p0\n", "")), "");
  EXPECT_NE(Broken(text, with("EXCLUDE_OBJECT_END NAME=p0\n", "EXCLUDE_OBJECT_END NAME=p1\n")), "");
  EXPECT_NE(Broken(text, with("EXCLUDE_OBJECT_START NAME=p0\n", "")), "");
  // A path of one object within the next one's label.
  EXPECT_NE(Broken(text, with("; stop printing object p0\nEXCLUDE_OBJECT_END NAME=p0\n"
                              "; printing object p1\nEXCLUDE_OBJECT_START NAME=p1\n",
                              "")),
            "");
}

TEST(VerifyMovedObjects, NothingPassesATemperature) {
  PillarPrint print;
  print.between = "M104 S210\nM104 S215\n";
  const std::string text = Text(print, Klipper());
  EXPECT_NE(Broken(text, WithLayer(text, 3, {1, 0, 2, 3})), "");
}

// Travel behind them is that of the place, not of the object.
TEST(VerifyMovedObjects, WhatIsBehindUnknownLinesStaysThere) {
  PillarPrint print;
  print.before_layer = kUnknownAndPicture;
  const std::string text = Text(print, Klipper());
  const std::string moved = WithLayer(text, 3, {1, 0, 2, 3});
  EXPECT_EQ(Broken(text, moved), "");
  const size_t layer = moved.find(";Z:0.6");
  for (const auto& [from, to] : {std::pair("G1 E-.8 F2100\nT", "G1 E-.8 F1200\nT"),
                                 std::pair("G1 E-.8 F2100\nT", "G1 E-.9 F2100\nT"),
                                 std::pair("G1 Z0.6 F9000", "G1 Z0.6 F600")}) {
    std::string other = moved;
    const size_t at = other.find(from, layer);
    ASSERT_NE(at, std::string::npos) << from;
    EXPECT_NE(Broken(text, other.replace(at, std::string(from).size(), to)), "") << to;
  }
}

// Each object was looked for among all others.
TEST(VerifyMovedObjects, ThousandsThatChangePlacesTakeNoLongerEach) {
  const auto check = [](int objects) {
    const auto object = [](int i) {
      return absl::StrCat("; printing object a", i, " id:", i, " copy 0\nG1 E-1 F2100\nG1 X",
                          i % 100 * 3, " Y", i / 100 * 3, " F9000\nG1 E1 F2100\nG1 X",
                          i % 100 * 3 + 2, " E.1 F1200\n; stop printing object a", i, " id:", i,
                          " copy 0\n");
    };
    std::string was = "; generated by PrusaSlicer 2.5.0 on x\nM83\n;LAYER_CHANGE\nG1 Z.2 F9000\n";
    std::string is = was;
    for (int i = 0; i < objects; ++i) {
      absl::StrAppend(&was, object(i));
      absl::StrAppend(&is, object(objects - 1 - i));
    }
    EXPECT_EQ(Broken(was, is), "");
  };
  EXPECT_LT(traverse::testing::GrowthOfFour(8000, check), traverse::testing::kSlowGrowth);
}

}  // namespace
}  // namespace traverse::gcode
