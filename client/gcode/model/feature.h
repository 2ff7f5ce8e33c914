// The kind of thing that a path belongs to: wall, infill, support.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_FEATURE_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_FEATURE_H_

#include <cstdint>
#include <string_view>

#include "client/gcode/model/gcode_file.h"

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

// The feature that the text after `;TYPE:` or `; FEATURE: ` names, in the words of PrusaSlicer,
// SuperSlicer, OrcaSlicer and CuraEngine; kCount if it is not one of theirs.
Feature FeatureOfType(std::string_view type);

// The feature named by the type in force at `block`; kCount if there is none, or it is unknown.
Feature NamedFeature(const GcodeFile& file, const Block& block);

// The feature of `block`: by its type, else by the comment on its first line (Slic3r with verbose
// G-code), else by its shape, `closed` or not.
Feature FeatureOf(const GcodeFile& file, const Block& block, bool closed);

inline bool IsWall(Feature feature) {
  return feature == Feature::kLoop || feature == Feature::kOuterWall ||
         feature == Feature::kInnerWall || feature == Feature::kOverhangWall;
}

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_FEATURE_H_
