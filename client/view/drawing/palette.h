// Colors of features, for both pictures and the report.

#ifndef TRAVERSE_CLIENT_VIEW_DRAWING_PALETTE_H_
#define TRAVERSE_CLIENT_VIEW_DRAWING_PALETTE_H_

#include <string>

#include "client/view/scene/scene.h"

namespace traverse::view {

// "#rrggbb" for a light ground and for a dark one.
struct FeatureColor {
  std::string light;
  std::string dark;
};

// The color of the feature with that name (gcode::FeatureName, or FeatureNames of the view); gray
// for others. Features that adjoin differ in lightness too, for people who see few colors.
FeatureColor ColorOf(const std::string& feature);

// For travel by its form, with what it is called, and for its ends, on a light ground.
struct TravelColor {
  const char* name;
  const char* light;
};
TravelColor ColorOf(DrawnForm form);

inline constexpr char kTravelColor[] = "#111827";
inline constexpr char kStartColor[] = "#15803d";
inline constexpr char kEndColor[] = "#be123c";

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_DRAWING_PALETTE_H_
