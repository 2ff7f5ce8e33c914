// What the lines of each slicer that are no moves mean: whether paths may change places across
// them.

#include <gtest/gtest.h>

#include <string>

#include "client/gcode/model/block_feature.h"
#include "client/gcode/plan/layer_plan.h"
#include "client/gcode/plan/policy.h"
#include "tests/client/gcode/support/random_order.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/verified.h"

namespace traverse::gcode {
namespace {

using testing::Read;

enum class Effect {
  kNone,       // paths pass it
  kFan,        // they do under `free` alone
  kDivides,    // none passes it, but those beside it may move
  kFixesPath,  // none passes it, and the path before it stays
};

struct MarkCase {
  const char* slicer;
  const char* lines;
  Effect effect;
};

void PrintTo(const MarkCase& mark, std::ostream* out) { *out << mark.slicer << ": " << mark.lines; }

constexpr MarkCase kMarks[] = {
    {"PrusaSlicer", ";TYPE:Internal infill", Effect::kNone},
    {"PrusaSlicer", ";WIDTH:0.5", Effect::kNone},
    {"PrusaSlicer", ";HEIGHT:0.25", Effect::kNone},
    {"PrusaSlicer", ";LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2", Effect::kDivides},
    {"PrusaSlicer", ";COLOR_CHANGE,T0,#FF0000\nM600", Effect::kFixesPath},
    {"PrusaSlicer", ";PAUSE_PRINT\nM601", Effect::kFixesPath},
    {"PrusaSlicer", ";CUSTOM_GCODE\nM300 S440 P200", Effect::kNone},
    {"PrusaSlicer", "; printing object bolt.stl id:0 copy 1", Effect::kDivides},
    {"PrusaSlicer", "; stop printing object bolt.stl id:0 copy 0", Effect::kDivides},
    {"PrusaSlicer", "M486 S1", Effect::kDivides},
    {"PrusaSlicer", "M486 S-1", Effect::kDivides},
    {"PrusaSlicer", "EXCLUDE_OBJECT_START NAME='a b \u00e9 (1)'", Effect::kDivides},
    {"PrusaSlicer", "EXCLUDE_OBJECT_END NAME='a b'", Effect::kDivides},
    {"PrusaSlicer", "; objects_info = {\"objects\":[{\"name\":\"G1 X5 E1\"}]}", Effect::kNone},
    {"PrusaSlicer", "M204 P500 T900", Effect::kNone},
    {"PrusaSlicer", "M201 X500 Y500", Effect::kNone},
    {"PrusaSlicer", "M74 W1.2", Effect::kDivides},
    {"PrusaSlicer", "M106 S99", Effect::kFan},
    {"PrusaSlicer", "M73 P5 R9", Effect::kNone},
    {"PrusaSlicer", "M73 Q5 S9 C3 D2", Effect::kNone},
    {"OrcaSlicer", "SET_VELOCITY_LIMIT ACCEL=500", Effect::kNone},
    {"OrcaSlicer", "SET_PRESSURE_ADVANCE ADVANCE=0.02", Effect::kNone},
    {"OrcaSlicer", "TIMELAPSE_TAKE_FRAME", Effect::kDivides},
    {"OrcaSlicer", "M900 K0.05", Effect::kNone},
    {"Bambu Studio", "; CHANGE_LAYER\n; Z_HEIGHT: 0.2\n; LAYER_HEIGHT: 0.2", Effect::kDivides},
    {"Bambu Studio", "; FEATURE: Sparse infill", Effect::kNone},
    {"Bambu Studio", "; LINE_WIDTH: 0.42", Effect::kNone},
    {"Bambu Studio", "M73 L4", Effect::kNone},
    {"Bambu Studio", "; OBJECT_ID: 15", Effect::kDivides},
    {"Bambu Studio",
     "; start printing object, unique label id: 15\nM624 AQAAAAAAAAA=", Effect::kDivides},
    {"Bambu Studio", "; stop printing object, unique label id: 15\nM625", Effect::kDivides},
    {"Bambu Studio", "; FLUSH_START\nM400\n; FLUSH_END", Effect::kFixesPath},
    {"Bambu Studio",
     "M622.1 S1\nM1002 judge_flag timelapse\nM622 J1\n ; picture\nM971 S11 C11 O0\n\nM623\n"
     "M991 S0 P1",
     Effect::kDivides},
    {"Bambu Studio", "M622 J1\nG1 X65 Y245 F20000\nM971 S11 C11 O0\nM623", Effect::kFixesPath},
    {"Bambu Studio", "M622 J1\nM106 S255\nM623", Effect::kFixesPath},
    {"OctoPrint", "@EXCLUDEREGION a", Effect::kDivides},
    {"OctoPrint", "@PAUSE", Effect::kFixesPath},
    {"Bambu Studio", "M142 P1 R35 S40", Effect::kDivides},
    {"CuraEngine", ";LAYER:7", Effect::kDivides},
    {"CuraEngine", ";MESH:a b.stl", Effect::kDivides},
    {"CuraEngine", ";MESH:NONMESH", Effect::kDivides},
    {"CuraEngine", ";TIME_ELAPSED:12.5", Effect::kNone},
    {"CuraEngine", "M117 Layer 3/20", Effect::kNone},
    {"CuraEngine", "M117 Time Left 1h2m3s", Effect::kNone},
    {"CuraEngine", "M117 Hello", Effect::kNone},
    {"CuraEngine", "M118 Hello", Effect::kDivides},
    {"CuraEngine", "G92 E0", Effect::kNone},
    {"CuraEngine", "M205 X20 Y20", Effect::kNone},
    {"ideaMaker", ";PRINTING:cube.stl", Effect::kDivides},
    {"ideaMaker", ";PRINTING_ID: 2", Effect::kDivides},
    {"ideaMaker", ";REMAINING_TIME: 60", Effect::kNone},
    {"ideaMaker", ";PRINTING_TIME: 60", Effect::kNone},
    {"Simplify3D", "; layer 2, Z = 0.200", Effect::kDivides},
    {"Simplify3D", "; feature infill", Effect::kNone},
    {"Simplify3D", "; infill", Effect::kNone},
    {"Simplify3D", "; tool H0.200 W0.480", Effect::kNone},
    {"Simplify3D", "; process ABS", Effect::kNone},
    {"KISSlicer", "; BEGIN_LAYER_OBJECT z=0.20 z_thickness=0.20", Effect::kDivides},
    {"KISSlicer", "; END_LAYER_OBJECT z=0.20", Effect::kDivides},
    {"KISSlicer", "; 'Solid Path', 0.4 [feed mm/s], 20.0 [head mm/s]", Effect::kNone},
    {"FlashPrint", ";layer:0.20", Effect::kDivides},
    {"FlashPrint", ";infill", Effect::kNone},
    {"IceSL", "; <layer>", Effect::kDivides},
    {"IceSL", "; </layer>", Effect::kDivides},
    {"Kiri:Moto", ";; --- layer 2 (0.2 @ 0.4) ---", Effect::kDivides},
    {"Canvas", "; layer 2, Z = 0.2", Effect::kDivides},
};

// Eight lines of infill, with the mark behind the fourth.
std::string WithMark(const std::string& mark) {
  std::string text = "; generated by PrusaSlicer 2.5.0 on x\nM83\n;LAYER_CHANGE\nM204 P700 T700\n";
  text += "M201 X700 Y700\nM205 X9 Y9\nM900 K.1\nSET_PRESSURE_ADVANCE ADVANCE=.1\nM106 S255\n";
  text += "SET_VELOCITY_LIMIT ACCEL=700\n;WIDTH:.45\n;HEIGHT:.2\nG1 Z.2 F9000\n";
  text += ";TYPE:Internal infill\n";
  for (const int y : {0, 50, 10, 40, 20, 60, 30, 70}) {
    const std::string at = std::to_string(y);
    text += "G1 X0 Y" + at + " F9000\nG1 F1200\nG1 X9 Y" + at + " E.5\n";
    if (y == 40) text += mark + "\n";
  }
  return text + "M107\n";
}

class MarkOfSlicer : public ::testing::TestWithParam<MarkCase> {};

TEST_P(MarkOfSlicer, LetsPathsPassOrNot) {
  const Effect effect = GetParam().effect;
  const auto file = Read(WithMark(GetParam().lines));
  ASSERT_EQ(file->blocks.size(), 8u);
  const auto passes = [&](Policy policy) {
    if (file->layers.size() > 1) return false;
    const LayerFreedom freedom = FreedomOf(*file, file->layers[0], policy, {});
    return freedom.group[3] == freedom.group[4];
  };
  const Layer& layer = file->layers.front();
  const LayerFreedom freedom = FreedomOf(*file, layer, Policy::kSafe, {});

  EXPECT_EQ(passes(Policy::kSafe), effect == Effect::kNone);
  EXPECT_EQ(passes(Policy::kFree), effect == Effect::kNone || effect == Effect::kFan);
  EXPECT_EQ(freedom.rules[3].pinned, effect == Effect::kFixesPath);
  EXPECT_EQ(FreedomOf(*file, file->layers.back(), Policy::kSafe, {})
                .rules[4 - file->layers.back().first_block]
                .pinned,
            false);
}

TEST_P(MarkOfSlicer, StaysInOtherOrders) {
  const std::string text = WithMark(GetParam().lines);
  const auto file = Read(text);
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const std::string shuffled = testing::Shuffled(*file, Policy::kFree, seed);
    EXPECT_EQ(VerifyGcode(text, "original", shuffled, "shuffled", OnlySamePrint()).message(), "")
        << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Today, MarkOfSlicer, ::testing::ValuesIn(kMarks));

// In the words of each slicer that names features.
TEST(FeatureOfType, KnowsTheNamesOfEachSlicer) {
  const std::pair<const char*, Feature> names[] = {
      {"External perimeter", Feature::kOuterWall},
      {"Overhang perimeter", Feature::kOverhangWall},
      {"Top solid infill", Feature::kTopInfill},
      {"Support material interface", Feature::kSupportInterface},
      {"Wipe tower", Feature::kTower},
      // Bambu Studio, OrcaSlicer
      {" Outer wall", Feature::kOuterWall},
      {"Inner wall", Feature::kInnerWall},
      {"Overhang wall", Feature::kOverhangWall},
      {"Sparse infill", Feature::kSparseInfill},
      {"Internal solid infill", Feature::kSolidInfill},
      {"Top surface", Feature::kTopInfill},
      {"Bottom surface", Feature::kBottomInfill},
      {"Bridge", Feature::kBridge},
      {"Gap infill", Feature::kGapFill},
      {"Support", Feature::kSupport},
      {"Support interface", Feature::kSupportInterface},
      {"Support transition", Feature::kSupportInterface},
      {"Prime tower", Feature::kTower},
      {"Custom", Feature::kCustom},
      {"Floating vertical shell", Feature::kSolidInfill},
      {"Skirt", Feature::kSkirt},
      {"Brim", Feature::kSkirt},
      {"Ironing", Feature::kIroning},
      // CuraEngine, ideaMaker
      {"WALL-OUTER", Feature::kOuterWall},
      {"WALL-INNER", Feature::kInnerWall},
      {"SKIN", Feature::kSolidInfill},
      {"FILL", Feature::kSparseInfill},
      {"SKIRT", Feature::kSkirt},
      {"SUPPORT", Feature::kSupport},
      {"SUPPORT-INTERFACE", Feature::kSupportInterface},
      {"PRIME-TOWER", Feature::kTower},
      {"SOLID-FILL", Feature::kSolidInfill},
      {"BRIDGE", Feature::kBridge},
      {"RAFT", Feature::kSupport},
      // Simplify3D, FlashPrint, KISSlicer
      {"outer perimeter", Feature::kOuterWall},
      {"inner perimeter", Feature::kInnerWall},
      {"shell", Feature::kLoop},
      {"infill", Feature::kSparseInfill},
      {"prime pillar", Feature::kTower},
      {"Perimeter Path", Feature::kOuterWall},
      {"Prime Pillar Path", Feature::kTower},
  };
  for (const auto& [name, feature] : names) EXPECT_EQ(FeatureOfType(name), feature) << name;
}

// Wipes follow arcs, and arcs that push nothing are travel: the paths beside them may move.
TEST(ReadGcode, ArcsBetweenPathsFixNone) {
  std::string text = "; generated by PrusaSlicer 2.9.2 on x\nM83\n;LAYER_CHANGE\nG1 Z.2 F9000\n";
  text += "G1 E-.8 F2100\n;TYPE:Internal infill\n";
  for (const int y : {0, 40, 10, 30, 20, 50}) {
    const std::string at = std::to_string(y);
    text += "G1 X0 Y" + at + " F9000\nG1 E.8 F2100\nG1 F1200\nG3 X9 Y" + at + " I4.5 J0 E.7\n";
    text += ";WIPE_START\nG1 F7200\nG2 X4.5 Y" + std::to_string(y - 4) + ".5 I-4.5 J0 E-.76\n";
    text += ";WIPE_END\nG1 E-.04 F2100\n";
    if (y == 10) text += "G3 X8 Y20 I9 J0 E0 F9000\n";
  }
  text += "M107\n";
  const auto file = Read(text);

  EXPECT_GE(MakeLayerPlan(*file, file->layers[0], Policy::kSafe).movable, 4);
  for (const Policy policy : {Policy::kSafe, Policy::kFree}) {
    const std::string shuffled = testing::Shuffled(*file, policy, 1);
    EXPECT_EQ(VerifyGcode(text, "original", shuffled, "shuffled", OnlySamePrint()).message(), "");
  }
}

}  // namespace
}  // namespace traverse::gcode
