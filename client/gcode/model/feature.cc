#include "client/gcode/model/feature.h"

#include <cstddef>
#include <string>

#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

struct TypeName {
  std::string_view name;
  Feature feature;
};

constexpr TypeName kTypeNames[] = {
    // PrusaSlicer, SuperSlicer
    {"Perimeter", Feature::kInnerWall},
    {"Internal perimeter", Feature::kInnerWall},
    {"External perimeter", Feature::kOuterWall},
    {"Overhang perimeter", Feature::kOverhangWall},
    {"Thin wall", Feature::kOuterWall},
    {"Internal infill", Feature::kSparseInfill},
    {"Solid infill", Feature::kSolidInfill},
    {"Top solid infill", Feature::kTopInfill},
    {"Bridge infill", Feature::kBridge},
    {"Internal bridge infill", Feature::kBridge},
    {"Gap fill", Feature::kGapFill},
    {"Ironing", Feature::kIroning},
    {"Skirt/Brim", Feature::kSkirt},
    {"Skirt", Feature::kSkirt},
    {"Brim", Feature::kSkirt},
    {"Support material", Feature::kSupport},
    {"Support material interface", Feature::kSupportInterface},
    {"Wipe tower", Feature::kTower},
    {"Custom", Feature::kCustom},
    // OrcaSlicer
    {"Inner wall", Feature::kInnerWall},
    {"Outer wall", Feature::kOuterWall},
    {"Overhang wall", Feature::kOverhangWall},
    {"Sparse infill", Feature::kSparseInfill},
    {"Internal solid infill", Feature::kSolidInfill},
    {"Bottom surface", Feature::kBottomInfill},
    {"Floating vertical shell", Feature::kSolidInfill},
    {"Internal bridge", Feature::kBridge},
    {"External bridge infill", Feature::kBridge},
    {"Mill", Feature::kCustom},
    {"Top surface", Feature::kTopInfill},
    {"Bridge", Feature::kBridge},
    {"Internal Bridge", Feature::kBridge},
    {"Gap infill", Feature::kGapFill},
    {"Support", Feature::kSupport},
    {"Support interface", Feature::kSupportInterface},
    {"Support transition", Feature::kSupportInterface},
    {"Prime tower", Feature::kTower},
    // CuraEngine
    {"WALL-OUTER", Feature::kOuterWall},
    {"WALL-INNER", Feature::kInnerWall},
    {"SKIN", Feature::kSolidInfill},
    {"FILL", Feature::kSparseInfill},
    {"SKIRT", Feature::kSkirt},
    {"SUPPORT", Feature::kSupport},
    {"SUPPORT-INTERFACE", Feature::kSupportInterface},
    {"PRIME-TOWER", Feature::kTower},
    // ideaMaker
    {"SOLID-FILL", Feature::kSolidInfill},
    {"GAP-FILL", Feature::kGapFill},
    {"BRIDGE", Feature::kBridge},
    {"RAFT", Feature::kSupport},
    {"DENSE-SUPPORT", Feature::kSupportInterface},
    {"IRONING", Feature::kIroning},
    // Simplify3D, FlashPrint
    {"outer perimeter", Feature::kOuterWall},
    {"inner perimeter", Feature::kInnerWall},
    {"external single extrusion", Feature::kOuterWall},
    {"internal single extrusion", Feature::kGapFill},
    {"single extrusion", Feature::kGapFill},
    {"gap fill", Feature::kGapFill},
    {"infill", Feature::kSparseInfill},
    {"solid layer", Feature::kSolidInfill},
    {"support", Feature::kSupport},
    {"dense support", Feature::kSupportInterface},
    {"raft", Feature::kSupport},
    {"skirt", Feature::kSkirt},
    {"brim", Feature::kSkirt},
    {"bridge", Feature::kBridge},
    {"ironing", Feature::kIroning},
    {"prime pillar", Feature::kTower},
    {"ooze shield", Feature::kTower},
    {"shell", Feature::kLoop},
    {"outer shell", Feature::kOuterWall},
    {"inner shell", Feature::kInnerWall},
    {"internal shell", Feature::kInnerWall},
    // KISSlicer
    {"Perimeter Path", Feature::kOuterWall},
    {"Loop Path", Feature::kInnerWall},
    {"Solid Path", Feature::kSolidInfill},
    {"Sparse Infill Path", Feature::kSparseInfill},
    {"Stacked Sparse Infill Path", Feature::kSparseInfill},
    {"Crown Path", Feature::kSolidInfill},
    {"Support Path", Feature::kSupport},
    {"Support (may Stack) Path", Feature::kSupport},
    {"Support Interface Path", Feature::kSupportInterface},
    {"Raft Path", Feature::kSupport},
    {"Skirt Path", Feature::kSkirt},
    {"Pillar Path", Feature::kTower},
    {"Prime Pillar Path", Feature::kTower},
};

// Slic3r, on each move with verbose G-code.
constexpr TypeName kCommentNames[] = {
    {"perimeter", Feature::kLoop},
    {"infill", Feature::kLine},
    {"skirt", Feature::kSkirt},
    {"brim", Feature::kSkirt},
    {"support material", Feature::kSupport},
    {"support material interface", Feature::kSupportInterface},
};

template <size_t n>
Feature Find(const TypeName (&names)[n], std::string_view name) {
  for (const TypeName& known : names) {
    if (known.name == name) return known.feature;
  }
  return Feature::kCount;
}

// The text after the mark in a line that sets the type.
std::string_view TypeName(std::string_view line) {
  if (const size_t colon = line.find(':'); colon != std::string_view::npos) {
    return line.substr(colon + 1);
  }
  // `; 'Loop Path', 0.2 [feed mm/s], ...`
  if (const size_t quote = line.find('\''); quote != std::string_view::npos) {
    const std::string_view name = line.substr(quote + 1);
    return name.substr(0, name.find('\''));
  }
  constexpr std::string_view kFeatureMark = "feature ";
  line = TrimBlanks(line.substr(1));
  return StartsWith(line, kFeatureMark) ? line.substr(kFeatureMark.size()) : line;
}

Feature FeatureOfComment(const GcodeFile& file, const Block& block) {
  const Line line = LineAt(file.text, block.begin);
  const std::string_view text = line.Text(file.text);
  const size_t semicolon = text.find(';');
  if (semicolon == std::string_view::npos) return Feature::kCount;
  return Find(kCommentNames, TrimBlanks(text.substr(semicolon + 1)));
}

}  // namespace

std::string_view FeatureName(Feature feature) {
  static constexpr std::string_view kNames[] = {
      "loop",     "line",          "outer wall",     "inner wall",    "overhang wall",
      "gap fill", "sparse infill", "solid infill",   "bottom infill", "top infill",
      "bridge",   "ironing",       "skirt and brim", "support",       "support interface",
      "tower",    "start script"};
  static_assert(sizeof(kNames) / sizeof(kNames[0]) == static_cast<size_t>(Feature::kCount));
  return kNames[static_cast<size_t>(feature)];
}

Feature FeatureOfType(std::string_view type) { return Find(kTypeNames, TrimBlanks(type)); }

Feature NamedFeature(const GcodeFile& file, const Block& block) {
  const uint32_t setter = file.states[block.state_in][kSlotType];
  if (setter == 0) return Feature::kCount;
  return FeatureOfType(TypeName(file.setters.Line(setter)));
}

Feature FeatureOf(const GcodeFile& file, const Block& block, bool closed) {
  const Feature named = NamedFeature(file, block);
  if (named == Feature::kLoop && !closed) return Feature::kOverhangWall;
  if (named != Feature::kCount) return named;
  const Feature commented = FeatureOfComment(file, block);
  if (commented == Feature::kLoop && !closed) return Feature::kOverhangWall;
  if (commented != Feature::kCount) return commented;
  return closed ? Feature::kLoop : Feature::kLine;
}

}  // namespace traverse::gcode
