// The seam of an outer wall: under `safe` the same point, under `balanced` that or a sharp corner.

#include <cmath>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

constexpr double kSharpRadians = 0.49;

Point PointOf(const TraceChunk& chunk, const TracePath& path, uint32_t index) {
  return chunk.StartOf(path, path.first_segment + index % path.size());
}

// By how much the loop turns where segment `index` begins.
double TurnAt(const TraceChunk& chunk, const TracePath& path, uint32_t index) {
  const uint32_t n = path.size();
  const Point here = PointOf(chunk, path, index);
  // Over the gap of a loop, which lies between its last point and its first one.
  const Point before = PointOf(chunk, path, index + n - 1);
  const Point behind = PointOf(chunk, path, index + 1);
  const double in = std::atan2(here.y - before.y, here.x - before.x);
  const double out = std::atan2(behind.y - here.y, behind.x - here.x);
  return std::abs(std::remainder(out - in, 2 * M_PI));
}

}  // namespace

void CheckSeam(const LayerPair& layer, const RuleContext& context, LayerFindings& findings) {
  if (context.permissions.is_free()) return;
  const TraceChunk& was = layer.was();
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) return;
    if (!layer.Closed(visit.path) || !layer.Outer(visit.path)) continue;
    const TracePath& path = was.paths[visit.path];
    const uint32_t begin = visit.forward ? visit.entry : (visit.entry + 1) % path.size();
    const bool balanced = context.permissions.policy == VerifyPermissions::Policy::kBalanced;
    const Point seam = PointOf(was, path, begin);
    if (begin == 0 || (balanced && Distance(seam, path.start) <= kOnPathMm)) continue;
    if (balanced && TurnAt(was, path, begin) >= kSharpRadians) continue;
    findings.breaks.push_back(
        {VerifyRule::kSeam, was.LineOf(path), layer.LineOf(visit),
         absl::StrFormat("the seam of this %s is %.2f mm from where it was%s",
                         PathClassName(layer.ClassOf(visit.path)), Distance(seam, path.start),
                         balanced ? ", and not at a sharp corner" : "")});
  }
}

}  // namespace traverse::gcode
