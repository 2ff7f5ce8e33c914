// A new way is straight, but for bends that lead around an outer wall: without such a bend the way
// would cross one, and with it does not. So no way overshoots what it leads to, and none is led
// along a wall.

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/tails.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// A move so short with which a way begins goes along a path's end, or away from it: path_ends.
constexpr double kDepartureMm = 1.0;

// Rounded coordinates bend a way by less.
constexpr double kLeastExcessMm = 0.05;

// How much longer the way is for the bend between the two.
double ExcessOf(const TraceMove& before, const TraceMove& behind) {
  return before.length_mm() + behind.length_mm() - DistanceOf(before.from, behind.to);
}

bool LeadsAroundAWall(const LayerPair& layer, const TraceMove& before, const TraceMove& behind) {
  return layer.CrossesOuterWall(before.from, behind.to) &&
         !layer.CrossesOuterWall(before.from, before.to) &&
         !layer.CrossesOuterWall(behind.from, behind.to);
}

void CheckLink(const LayerPair& layer, uint32_t link, uint32_t skipped, LayerFindings& findings) {
  const TraceChunk& is = layer.is();
  const TraceLink& traced = is.links[link];
  if (traced.scripted) return;
  double length = 0;
  const TraceMove* before = nullptr;
  for (uint32_t m = traced.first_move + skipped; m < traced.end_move; ++m) {
    const TraceMove& move = is.moves[m];
    if (!move.sideways()) continue;
    const bool counts = move.kind == MoveKind::kTravel && move.in_print && !move.arc;
    const double done = std::exchange(length, length + move.length_mm());
    const TraceMove* last = std::exchange(before, counts ? &move : nullptr);
    if (last == nullptr || before == nullptr) continue;
    if (layer.IsKnown(*last) || layer.IsKnown(move)) continue;
    if (done <= kDepartureMm) continue;
    const double excess = ExcessOf(*last, move);
    if (excess <= kLeastExcessMm || LeadsAroundAWall(layer, *last, move)) continue;
    findings.breaks.push_back(
        {VerifyRule::kBounds, 0, last->line, layer.index(),
         absl::StrFormat("a way is %.2f mm longer for a bend that leads around no outer wall",
                         excess)});
  }
}

}  // namespace

void CheckBends(const LayerPair& layer, LayerFindings& findings) {
  const Tails tails(layer, false);
  // What goes along a path may be as fast as travel.
  const Tails along(layer, false, true);
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    CheckLink(layer, link, std::max(tails.At(link), along.At(link)), findings);
  }
}

}  // namespace traverse::gcode
