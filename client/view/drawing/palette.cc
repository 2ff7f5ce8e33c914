#include "client/view/drawing/palette.h"

namespace traverse::view {
namespace {

struct Row {
  const char* feature;
  const char* light;
  const char* dark;
};

// Walls are warm, fillings cool, discarded material green and gray.
constexpr Row kRows[] = {
    {"outer wall", "#e8590c", "#ff8a47"},    {"outer contour", "#e8590c", "#ff8a47"},
    {"inner wall", "#f0a430", "#ffc75f"},    {"inner contour", "#f0a430", "#ffc75f"},
    {"loop", "#e8590c", "#ff8a47"},          {"contour", "#e8590c", "#ff8a47"},
    {"overhang wall", "#7c3aed", "#a78bfa"}, {"gap fill", "#db2777", "#f472b6"},
    {"sparse infill", "#3b82f6", "#60a5fa"}, {"solid infill", "#38a3c9", "#67cbe9"},
    {"top infill", "#6366f1", "#939bff"},    {"bridge", "#0f766e", "#2dd4bf"},
    {"ironing", "#c084fc", "#d8b4fe"},       {"skirt and brim", "#65a30d", "#a3e635"},
    {"support", "#84a98c", "#9fc5a8"},       {"support interface", "#3f7d58", "#6fbf8f"},
    {"tower", "#94a3b8", "#a8b6c8"},         {"raster", "#3b82f6", "#60a5fa"},
    {"line", "#3b82f6", "#60a5fa"},          {"start script", "#94a3b8", "#a8b6c8"},
};

}  // namespace

FeatureColor ColorOf(const std::string& feature) {
  for (const Row& row : kRows) {
    if (feature == row.feature) return {row.light, row.dark};
  }
  return {"#94a3b8", "#a8b6c8"};
}

TravelColor ColorOf(DrawnForm form) {
  switch (form) {
    case DrawnForm::kTravel:
      break;
    case DrawnForm::kRetracted:
      return {"retracted travel", kTravelColor};
    case DrawnForm::kOpen:
      return {"open travel", "#dc2626"};
    case DrawnForm::kHidden:
      return {"hidden travel", "#16a34a"};
  }
  return {"travel", kTravelColor};
}

}  // namespace traverse::view
