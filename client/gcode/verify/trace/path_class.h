// The kind of thing that a path belongs to, as the comments of many slicers name it.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_PATH_CLASS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_PATH_CLASS_H_

#include <cstdint>
#include <optional>
#include <string_view>

namespace traverse::gcode {

enum class PathClass : uint8_t {
  kUnnamed,
  kOuterWall,
  kInnerWall,
  kOverhang,  // a wall, outer or inner
  kWall,      // a wall about which no more is known
  kInfill,
  kSkin,  // solid infill
  kTop,   // the surface that is visible from above
  kBottom,
  kIroning,
  kBridge,
  kSupport,
  kInterface,  // of supports
  kSkirt,      // or brim
  kTower,
  kScript,
  kCount,
};

// For people: "outer wall".
std::string_view PathClassName(PathClass path_class);

inline bool IsWallClass(PathClass path_class) {
  return path_class == PathClass::kOuterWall || path_class == PathClass::kInnerWall ||
         path_class == PathClass::kOverhang || path_class == PathClass::kWall;
}

// The class that a comment line sets for the following paths: `;TYPE:External perimeter`, `;
// FEATURE: Outer wall`, `; feature outer perimeter`, `; outer perimeter`, `; 'Perimeter Path',`,
// `;shell`. Unset for other comments; kUnnamed for a feature of unknown name.
std::optional<PathClass> ClassOfComment(std::string_view comment);

// The same for a comment on a move, as Slic3r writes it: `; perimeter`.
std::optional<PathClass> ClassOfMoveComment(std::string_view comment);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_TRACE_PATH_CLASS_H_
