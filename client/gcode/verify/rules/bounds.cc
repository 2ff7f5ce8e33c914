// No way leads out of the box that all moves of the original lie in.

#include <algorithm>
#include <array>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// A way around a wall may lie beyond all walls.
constexpr double kSlackMm = 2;

}  // namespace

void ObserveBounds(const TraceChunk& was, Box& box) {
  for (const TracePath& path : was.paths) box.Add(path.start);
  for (const TraceSegment& segment : was.segments) box.Add(segment.end);
  for (const TraceMove& move : was.moves) box.Add(move.to);
}

void ObserveFarMoves(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& is = layer.is();
  std::array<FarPoint, 4> farthest;
  const auto side = [](Point p, size_t k) {
    const double along = k < 2 ? p.x : p.y;
    return k % 2 == 0 ? along : -along;
  };
  for (uint32_t m = is.links[layer.first_path_is()].first_move;
       m < is.links[layer.end_path_is()].first_move; ++m) {
    const TraceMove& move = is.moves[m];
    if (!move.sideways() || layer.IsKnown(move)) continue;
    for (size_t k = 0; k < farthest.size(); ++k) {
      if (farthest[k].line != 0 && side(move.to, k) <= side(farthest[k].at, k)) continue;
      farthest[k] = {move.to, move.line, layer.index()};
    }
  }
  for (const FarPoint& point : farthest) {
    if (point.line != 0) findings.is.farthest.push_back(point);
  }
}

void CompareBounds(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  for (const FarPoint& far : is.farthest) {
    const Point p = far.at;
    const double off = std::max(
        {was.box.low.x - p.x, p.x - was.box.high.x, was.box.low.y - p.y, p.y - was.box.high.y});
    if (off <= kSlackMm) continue;
    breaks.push_back(
        {VerifyRule::kBounds, 0, far.line, far.layer,
         absl::StrFormat("leads %.2f mm out of the room that the original moves in", off)});
  }
}

}  // namespace traverse::gcode
