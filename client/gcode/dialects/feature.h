// The kind of thing that a path belongs to: wall, infill, support.

#ifndef TRAVERSE_CLIENT_GCODE_DIALECT_FEATURE_H_
#define TRAVERSE_CLIENT_GCODE_DIALECT_FEATURE_H_

#include <cstdint>
#include <string_view>

namespace traverse::gcode {

enum class Feature : uint8_t {
  kLoop,  // closed, in a file that does not name features
  kLine,  // open, in such a file
  kOuterWall,
  kInnerWall,
  kOverhangWall,
  kGapFill,
  kSparseInfill,
  kSolidInfill,
  kBottomInfill,
  kTopInfill,
  kBridge,
  kIroning,
  kSkirt,  // also brim: slicers do not always distinguish them
  kSupport,
  kSupportInterface,
  kTower,   // wipe or prime tower
  kCustom,  // start and end scripts
  kCount,
};

// For people: "outer wall".
std::string_view FeatureName(Feature feature);

inline bool IsWall(Feature feature) {
  return feature == Feature::kLoop || feature == Feature::kOuterWall ||
         feature == Feature::kInnerWall || feature == Feature::kOverhangWall;
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_DIALECT_FEATURE_H_
