// The direction of open walls, overhanging loops and outer loops is as sliced, but under `free`.

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {

void CheckDirection(const LayerPair& layer, const RuleContext& context, LayerFindings& findings) {
  if (context.permissions.policy == VerifyPermissions::Policy::kFree) return;
  for (const Visit& visit : layer.visits()) {
    if (visit.forward || !layer.IsWall(visit.path)) continue;
    const TracePath& path = layer.was().paths[visit.path];
    if (layer.Closed(visit.path) && !layer.Outer(visit.path) && !path.overhangs) continue;
    findings.breaks.push_back(
        {VerifyRule::kDirection, layer.was().LineOf(path),
         layer.is().segments[visit.first_segment].line, layer.index(),
         absl::StrFormat("this %s is printed the other way round",
                         std::string(PathClassName(layer.ClassOf(visit.path))))});
  }
}

}  // namespace traverse::gcode
