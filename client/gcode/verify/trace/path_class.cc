#include "client/gcode/verify/trace/path_class.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

struct Name {
  std::string_view name;  // in small letters, blanks, dashes and underlines as one blank
  PathClass path_class;
  bool bare = false;  // stands alone in a comment, of slicers that do not mark it as a feature
};

constexpr Name kNames[] = {
    // PrusaSlicer, SuperSlicer, Slic3r
    {"perimeter", PathClass::kInnerWall},
    {"internal perimeter", PathClass::kInnerWall},
    {"external perimeter", PathClass::kOuterWall},
    {"overhang perimeter", PathClass::kOverhang},
    {"thin wall", PathClass::kOuterWall},
    {"internal infill", PathClass::kInfill},
    {"solid infill", PathClass::kSkin},
    {"top solid infill", PathClass::kTop},
    {"bridge infill", PathClass::kBridge},
    {"internal bridge infill", PathClass::kBridge},
    {"gap fill", PathClass::kInfill, true},
    {"ironing", PathClass::kIroning, true},
    {"skirt/brim", PathClass::kSkirt},
    {"skirt", PathClass::kSkirt, true},
    {"brim", PathClass::kSkirt, true},
    {"support material", PathClass::kSupport},
    {"support material interface", PathClass::kInterface},
    {"wipe tower", PathClass::kTower},
    {"custom", PathClass::kScript},
    // OrcaSlicer, Bambu Studio
    {"inner wall", PathClass::kInnerWall},
    {"outer wall", PathClass::kOuterWall},
    {"overhang wall", PathClass::kOverhang},
    {"floating vertical shell", PathClass::kSkin},
    {"sparse infill", PathClass::kInfill},
    {"internal solid infill", PathClass::kSkin},
    {"bottom surface", PathClass::kBottom},
    {"top surface", PathClass::kTop},
    {"bridge", PathClass::kBridge, true},
    {"internal bridge", PathClass::kBridge},
    {"gap infill", PathClass::kInfill},
    {"support", PathClass::kSupport, true},
    {"support interface", PathClass::kInterface},
    {"support transition", PathClass::kInterface},
    {"prime tower", PathClass::kTower},
    {"flush", PathClass::kScript},
    // CuraEngine, ideaMaker
    {"wall outer", PathClass::kOuterWall},
    {"wall inner", PathClass::kInnerWall},
    {"skin", PathClass::kSkin},
    {"fill", PathClass::kInfill},
    {"solid fill", PathClass::kSkin},
    {"gap", PathClass::kInfill},
    {"raft", PathClass::kSupport, true},
    // Simplify3D
    {"outer perimeter", PathClass::kOuterWall, true},
    {"inner perimeter", PathClass::kInnerWall, true},
    {"single extrusion", PathClass::kInfill, true},
    {"external single extrusion", PathClass::kOuterWall, true},
    {"internal single extrusion", PathClass::kInfill, true},
    {"solid layer", PathClass::kSkin, true},
    {"dense support", PathClass::kInterface, true},
    {"prime pillar", PathClass::kTower, true},
    {"ooze shield", PathClass::kTower, true},
    {"infill", PathClass::kInfill, true},
    // KISSlicer
    {"perimeter path", PathClass::kOuterWall},
    {"loop path", PathClass::kInnerWall},
    {"solid path", PathClass::kSkin},
    {"sparse infill path", PathClass::kInfill},
    {"stacked sparse infill path", PathClass::kInfill},
    {"crown path", PathClass::kInfill},
    {"raft path", PathClass::kSupport},
    {"support interface path", PathClass::kInterface},
    {"support (may stack) path", PathClass::kSupport},
    {"support path", PathClass::kSupport},
    {"skirt path", PathClass::kSkirt},
    {"pillar path", PathClass::kTower},
    {"prime pillar path", PathClass::kTower},
    // FlashPrint
    {"shell", PathClass::kWall, true},
    {"internal shell", PathClass::kInnerWall, true},
    {"outer shell", PathClass::kOuterWall, true},
    {"inner shell", PathClass::kInnerWall, true},
};

std::string Plain(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const bool blank = c == ' ' || c == '-' || c == '_' || c == '\t' || c == '\r';
    if (blank && (plain.empty() || plain.back() == ' ')) continue;
    plain += blank ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  while (!plain.empty() && plain.back() == ' ') plain.pop_back();
  return plain;
}

PathClass Find(std::string_view name) {
  const std::string plain = Plain(name);
  const auto* found = std::ranges::find(kNames, plain, &Name::name);
  return found == std::end(kNames) ? PathClass::kUnnamed : found->path_class;
}

}  // namespace

std::string_view PathClassName(PathClass path_class) {
  constexpr std::string_view kClassNames[] = {
      "path",   "outer wall", "inner wall",        "overhang wall", "wall",
      "infill", "skin",       "top skin",          "bottom",        "ironing",
      "bridge", "support",    "support interface", "skirt or brim", "tower",
      "script"};
  static_assert(std::size(kClassNames) == static_cast<size_t>(PathClass::kCount));
  return kClassNames[static_cast<size_t>(path_class)];
}

std::optional<PathClass> ClassOfComment(std::string_view comment) {
  comment.remove_prefix(std::min(comment.find_first_not_of("; \t"), comment.size()));
  for (const std::string_view mark : {"TYPE:", "FEATURE:", "feature "}) {
    if (comment.starts_with(mark)) return Find(comment.substr(mark.size()));
  }
  if (comment.starts_with("'")) {
    const std::string_view name = comment.substr(1, comment.find('\'', 1) - 1);
    // Travel stands between paths, and says nothing of them.
    constexpr std::string_view kMoves[] = {"Travel", "Destring", "Wipe"};
    if (BeginsWithAny(name, kMoves)) return std::nullopt;
    return Find(name);
  }
  for (const Name& name : kNames) {
    if (name.bare && comment == name.name) return name.path_class;
  }
  return std::nullopt;
}

std::optional<PathClass> ClassOfMoveComment(std::string_view comment) {
  comment.remove_prefix(std::min(comment.find_first_not_of("; \t"), comment.size()));
  constexpr Name kMoveNames[] = {
      {"perimeter", PathClass::kWall},
      {"infill", PathClass::kInfill},
      {"skirt", PathClass::kSkirt},
      {"brim", PathClass::kSkirt},
      {"support material", PathClass::kSupport},
      {"support material interface", PathClass::kInterface},
  };
  for (const Name& name : kMoveNames) {
    if (comment == name.name) return name.path_class;
  }
  return std::nullopt;
}

}  // namespace traverse::gcode
