#include "client/gcode/dialects/feature.h"

#include <cstddef>

namespace traverse::gcode {

std::string_view FeatureName(Feature feature) {
  static constexpr std::string_view kNames[] = {
      "loop",     "line",          "outer wall",     "inner wall",    "overhang wall",
      "gap fill", "sparse infill", "solid infill",   "bottom infill", "top infill",
      "bridge",   "ironing",       "skirt and brim", "support",       "support interface",
      "tower",    "start script"};
  static_assert(sizeof(kNames) / sizeof(kNames[0]) == static_cast<size_t>(Feature::kCount));
  return kNames[static_cast<size_t>(feature)];
}

}  // namespace traverse::gcode
