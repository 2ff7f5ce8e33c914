// The direction of lines of ironing is as sliced; and but under `free` that of open walls,
// overhanging loops, outer loops and of lines of monotonic surfaces.

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {

void CheckDirection(const LayerPair& layer, const RuleContext& context, LayerFindings& findings) {
  const bool free = context.permissions.is_free();
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) return;
    if (visit.forward) continue;
    const TracePath& path = layer.was().paths[visit.path];
    const PathClass path_class = layer.ClassOf(visit.path);
    if (free && path_class != PathClass::kIroning) continue;
    const bool of_surface = path_class == PathClass::kIroning ||
                            (path_class == PathClass::kTop && context.settings.monotonic_top) ||
                            (path_class == PathClass::kBottom && context.settings.monotonic_bottom);
    if (!of_surface && !layer.IsWall(visit.path)) continue;
    const bool may_turn = path_class != PathClass::kIroning &&
                          (of_surface || (!layer.Outer(visit.path) && !path.overhangs));
    if (layer.Closed(visit.path) && may_turn) continue;
    findings.breaks.push_back({VerifyRule::kDirection, layer.was().LineOf(path),
                               layer.LineOf(visit),
                               absl::StrFormat("this %s is printed in the opposite direction",
                                               PathClassName(path_class))});
  }
}

}  // namespace traverse::gcode
