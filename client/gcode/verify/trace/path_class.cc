#include "client/gcode/verify/trace/path_class.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <unordered_map>

#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

struct Name {
  std::string_view name;  // in small letters, blanks, dashes and underlines as one blank
  PathClass path_class;
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
    {"gap fill", PathClass::kInfill},
    {"ironing", PathClass::kIroning},
    {"skirt/brim", PathClass::kSkirt},
    {"skirt", PathClass::kSkirt},
    {"brim", PathClass::kSkirt},
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
    {"bridge", PathClass::kBridge},
    {"internal bridge", PathClass::kBridge},
    {"gap infill", PathClass::kInfill},
    {"support", PathClass::kSupport},
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
    {"raft", PathClass::kSupport},
    // Simplify3D
    {"outer perimeter", PathClass::kOuterWall},
    {"inner perimeter", PathClass::kInnerWall},
    {"single extrusion", PathClass::kInfill},
    {"external single extrusion", PathClass::kOuterWall},
    {"internal single extrusion", PathClass::kInfill},
    {"solid layer", PathClass::kSkin},
    {"dense support", PathClass::kInterface},
    {"prime pillar", PathClass::kTower},
    {"ooze shield", PathClass::kTower},
    {"infill", PathClass::kInfill},
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
    {"shell", PathClass::kWall},
    {"internal shell", PathClass::kInnerWall},
    {"outer shell", PathClass::kOuterWall},
    {"inner shell", PathClass::kInnerWall},
};

// Names that stand alone in a comment, from slicers that do not mark them as features.
constexpr std::string_view kBareNames[] = {"outer perimeter",
                                           "inner perimeter",
                                           "single extrusion",
                                           "external single extrusion",
                                           "internal single extrusion",
                                           "solid layer",
                                           "gap fill",
                                           "infill",
                                           "support",
                                           "dense support",
                                           "bridge",
                                           "skirt",
                                           "brim",
                                           "ironing",
                                           "prime pillar",
                                           "ooze shield",
                                           "raft",
                                           "internal shell",
                                           "outer shell",
                                           "inner shell",
                                           "shell"};

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
  static const std::unordered_map<std::string, PathClass> known = [] {
    std::unordered_map<std::string, PathClass> map;
    for (const Name& n : kNames) map.emplace(std::string(n.name), n.path_class);
    return map;
  }();
  const auto found = known.find(Plain(name));
  return found == known.end() ? PathClass::kUnnamed : found->second;
}

}  // namespace

std::string_view PathClassName(PathClass path_class) {
  constexpr std::string_view kClassNames[] = {
      "path",    "outer wall",        "inner wall", "overhang wall", "wall",    "infill",
      "skin",    "top skin",          "bottom",     "bridge",        "ironing", "skirt or brim",
      "support", "support interface", "tower",      "script"};
  static_assert(std::size(kClassNames) == static_cast<size_t>(PathClass::kCount));
  return kClassNames[static_cast<size_t>(path_class)];
}

std::optional<PathClass> ClassOfComment(std::string_view comment) {
  comment.remove_prefix(std::min(comment.find_first_not_of("; \t"), comment.size()));
  for (const std::string_view mark : {"TYPE:", "FEATURE:", "feature "}) {
    if (Begins(comment, mark)) return Find(comment.substr(mark.size()));
  }
  if (Begins(comment, "'")) {
    const std::string_view name = comment.substr(1, comment.find('\'', 1) - 1);
    // Travel stands between paths, and says nothing of them.
    if (Begins(name, "Travel") || Begins(name, "Destring") || Begins(name, "Wipe")) {
      return std::nullopt;
    }
    return Find(name);
  }
  for (const std::string_view name : kBareNames) {
    if (comment == name) return Find(name);
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
